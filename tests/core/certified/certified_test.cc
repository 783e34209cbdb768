// Certified numbers against tests/data, against the models in doubles, against themselves at more digits, and at ties.

#include "core/certified/certified.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/answer/model_outcomes.h"
#include "core/models/restitution_law.h"
#include "core/plan/scene_problem.h"
#include "ricochet/outcome_numbers.h"
#include "ricochet/solver.h"
#include "tests/support/oracles/certificates.h"
#include "tests/support/oracles/ulp.h"
#include "tests/support/scenes/laws_by_name.h"
#include "tests/support/scenes/linkage_rows.h"
#include "tests/support/scenes/pendulum_scenes.h"
#include "tests/support/scenes/planar_scenes.h"
#include "tests/support/scenes/system_scenes.h"
#include "tests/support/scenes/vectors.h"

namespace ricochet {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// --- Against the vectors ---

using Columns = std::vector<std::pair<const char*, const char*>>;

// Tells whether they agree in the rows' 25 printed digits. What is proved to be 0 the rows have as what is left of a
// difference of some 40 or 60 digits.
bool AgreesWith(const std::string& printed, const CertifiedNumber& number) {
  if (number.decimal == "0" && number.exact) return std::fabs(std::stod(printed)) < 1e-35;
  return Agree(printed, number.decimal, 24);
}

void ExpectDigitsOf(const VectorRow& row, const Scene& scene, const Columns& columns) {
  const absl::StatusOr<Certificate> certificate = CertifySolve(scene, {25}, Never);
  ASSERT_TRUE(certificate.ok()) << certificate.status();
  ASSERT_FALSE(certificate->is_set);
  for (const auto& [column, path] : columns) {
    EXPECT_TRUE(AgreesWith(row.at(column), NumberAt(*certificate, path)))
        << column << ": " << row.at(column) << " but certified " << DecimalAt(*certificate, path);
  }
}

const Columns kPendulumColumns = {{"newton", "coefficients.newton"},
                                  {"poisson", "coefficients.poisson"},
                                  {"energetic", "coefficients.energetic"},
                                  {"omega_plus", "rates_after_rad_s[0]"},
                                  {"tau0", "impulse.normal_compression_n_s"},
                                  {"tau1", "impulse.normal_total_n_s"},
                                  {"friction_impulse", "impulse.tangential_n_s[0]"},
                                  {"mu_hat", "coefficients.tangential"},
                                  {"work_n_compression", "work.normal_compression_j"},
                                  {"work_n_restitution", "work.normal_restitution_j"},
                                  {"work_t_compression", "work.tangential_compression_j"},
                                  {"work_t_restitution", "work.tangential_restitution_j"}};

TEST(CertifiedVectorsTest, EveryDigitOfEveryPendulumIsThatOfTheIndependentProgram) {
  const std::vector<VectorRow> rows = ReadVectors("pendulum.csv");
  ASSERT_EQ(rows.size(), 240U);
  for (size_t i = 0; i < rows.size(); ++i) {
    SCOPED_TRACE(i);
    const VectorRow& row = rows[i];
    const Scene scene = {
        .system = Pendulum{Number(row, "j0"), Number(row, "a"), Number(row, "b"), Number(row, "omega_minus")},
        .friction = {.kinetic_coefficient = Number(row, "mu")},
        .restitution = RestitutionOf(row.at("law"), Number(row, "coefficient"))};
    ExpectDigitsOf(row, scene, kPendulumColumns);
    const Certificate certificate = *CertifySolve(scene, {25}, Never);
    const std::string& lost = row.at("energy_dissipated");
    EXPECT_TRUE(AgreesWith(lost[0] == '-' ? lost.substr(1) : "-" + lost, NumberAt(certificate, "energy_change_j")));
    EXPECT_EQ(row.at("regime") == "stick", certificate.regimes[0] == Regime::kLocked);
  }
}

const Columns kPlanarColumns = {{"u1", "contact_velocity_after.tangential_m_s[0]"},
                                {"v1", "contact_velocity_after.normal_m_s"},
                                {"tau_compression", "impulse.normal_compression_n_s"},
                                {"tau1", "impulse.normal_total_n_s"},
                                {"friction_impulse", "impulse.tangential_n_s[0]"},
                                {"work_n_compression", "work.normal_compression_j"},
                                {"work_n_restitution", "work.normal_restitution_j"},
                                {"work_t", "work.tangential_total_j"},
                                {"newton", "coefficients.newton"},
                                {"poisson", "coefficients.poisson"},
                                {"energetic", "coefficients.energetic"}};

TEST(CertifiedVectorsTest, EveryDigitOfEveryContactIsThatOfTheIndependentProgram) {
  const std::vector<VectorRow> rows = ReadVectors("planar.csv");
  ASSERT_EQ(rows.size(), 240U);
  for (size_t i = 0; i < rows.size(); ++i) {
    SCOPED_TRACE(i);
    const VectorRow& row = rows[i];
    const Scene scene = {.system = PlanarContact{Number(row, "wtt"), Number(row, "wtn"), Number(row, "wnn"),
                                                 Number(row, "u0"), Number(row, "v0")},
                         .friction = {.kinetic_coefficient = Number(row, "mu")},
                         .restitution = RestitutionOf(row.at("law"), Number(row, "coefficient"))};
    ExpectDigitsOf(row, scene, kPlanarColumns);
  }
}

TEST(CertifiedVectorsTest, EveryDigitOfEveryLinkageIsThatOfTheIndependentProgram) {
  const std::vector<VectorRow> rows = ReadVectors("linkage.csv");
  ASSERT_EQ(rows.size(), 66U);
  for (size_t i = 0; i < rows.size(); ++i) {
    SCOPED_TRACE(i);
    const VectorRow& row = rows[i];
    ExpectDigitsOf(row, ChainOf(row),
                   {{"tau1", "impulse.normal_total_n_s"},
                    {"friction_impulse", "impulse.tangential_n_s[0]"},
                    {"newton", "coefficients.newton"},
                    {"poisson", "coefficients.poisson"},
                    {"energetic", "coefficients.energetic"}});
    const std::vector<std::string> rates = SplitCells(row.at("rate_after"), ';');
    const Certificate certificate = *CertifySolve(ChainOf(row), {25}, Never);
    for (size_t k = 0; k < rates.size(); ++k) {
      const std::string path = "rates_after_rad_s[" + std::to_string(k) + "]";
      EXPECT_TRUE(AgreesWith(rates[k], NumberAt(certificate, path)))
          << path << ": " << rates[k] << " but certified " << DecimalAt(certificate, path);
    }
  }
}

// --- Against the models in doubles ---

TEST(CertifiedDoublesTest, TheClosedFormIsWithinOneUlpOfTheCertifiedNumberOver10000Pendulums) {
  pendulum::SceneSource source(7);
  for (int i = 0; i < 10000 && !HasFailure(); ++i) {
    const pendulum::Problem problem = source.Any();
    const pendulum::Impact impact = pendulum::Solve(problem);
    const absl::StatusOr<Certificate> certificate = CertifySolve(SceneOf(problem), {17}, Never);
    ASSERT_TRUE(certificate.ok()) << certificate.status();
    ASSERT_EQ(certificate->regimes, std::vector<Regime>{impact.regime}) << i;
    // 2^-100 of its scale where an output changes sign, as core/models/pendulum/pendulum.h grants.
    const double kappa = impact[pendulum::Output::kPoisson];
    const double tau0 = impact[pendulum::Output::kNormalImpulseCompression];
    for (int k = 0; k < pendulum::kOutputCount; ++k) {
      const auto output = static_cast<pendulum::Output>(k);
      const std::string path = pendulum::kOutputPaths[static_cast<size_t>(k)];
      if (path.empty()) continue;
      const CertifiedNumber number = NumberAt(*certificate, path);
      double scale = problem.mu * std::max(1.0, kappa);
      if (output == pendulum::Output::kTangentialImpulse) scale *= tau0;
      if (output == pendulum::Output::kWorkNormal || output == pendulum::Output::kEnergyChange) {
        scale = 2.0 * std::fabs(impact[pendulum::Output::kWorkNormalCompression]) +
                2.0 * std::fabs(impact[pendulum::Output::kWorkTangentialCompression]);
        const double eta = impact[pendulum::Output::kEnergetic];
        scale *= std::max(1.0, eta * eta);
      }
      EXPECT_TRUE(UlpDistance(impact[output], number.value) <= 1 ||
                  std::fabs(impact[output] - number.value) <= 0x1p-98 * scale)
          << i << " " << path << " " << impact[output] << " " << number.decimal;
    }
  }
}

// Tells whether a double is as accurate as core/models/planar/planar.h promises: 1 ulp, or `scale`.
bool IsPromised(double computed, double exact, double scale) {
  return UlpDistance(computed, exact) <= 1 || std::fabs(computed - exact) <= scale;
}

TEST(CertifiedDoublesTest, ThePlanarModelKeepsItsPromiseOver10000Contacts) {
  planar::SceneSource source(11);
  int compared = 0;
  for (int i = 0; i < 10000 && !HasFailure(); ++i) {
    const planar::Problem p = source.Any();
    const planar::Impact impact = planar::Solve(p);
    const absl::StatusOr<Certificate> certificate = CertifySolve(SceneOf(p), {17}, Never);
    const bool near_rank_one = planar::SceneSource::IsRankOne(p);
    if (near_rank_one && p.w.tt != 0.0) continue;  // The certificate takes W at its word.
    ASSERT_TRUE(certificate.ok()) << i << certificate.status();
    ++compared;
    ASSERT_EQ(certificate->regimes, std::vector<Regime>{impact.regime}) << i;
    const double product = p.w.tt * p.w.nn;
    const double det = std::fma(p.w.tt, p.w.nn, -p.w.tn * p.w.tn);
    const double c = p.w.tt == 0.0 ? 1.0 : 2.0 * product / det * (1.0 + p.mu * std::fabs(p.w.tn) / p.w.nn);
    const double tiny = 0x1p-94 * c;
    const double speed = std::max(std::fabs(p.u0), std::fabs(p.v0));
    const double friction = std::max(p.mu, p.w.tt == 0.0 ? 0.0 : std::fabs(p.w.tn) / p.w.tt);
    const double work =
        std::max({std::fabs(impact.work_normal_compression), std::fabs(impact.work_normal_restitution),
                  std::fabs(impact.work_tangential_compression), std::fabs(impact.work_tangential_restitution)});
    const auto check = [&](const char* path, double computed, double scale) {
      const CertifiedNumber number = NumberAt(*certificate, path);
      EXPECT_TRUE(IsPromised(computed, number.value, tiny * scale))
          << i << " " << path << " " << computed << " " << number.decimal;
    };
    check("contact_velocity_after.tangential_m_s[0]", impact.u1, speed);
    check("contact_velocity_after.normal_m_s", impact.v1, speed);
    check("impulse.normal_compression_n_s", impact.tau_compression, impact.tau1);
    check("impulse.normal_total_n_s", impact.tau1, impact.tau1);
    check("impulse.tangential_n_s[0]", impact.f1, friction * impact.tau1);
    check("work.normal_compression_j", impact.work_normal_compression, work);
    check("work.normal_restitution_j", impact.work_normal_restitution, work);
    check("work.tangential_compression_j", impact.work_tangential_compression, work);
    check("work.tangential_restitution_j", impact.work_tangential_restitution, work);
    check("energy_change_j", impact.energy_change, 4.0 * work);
    check("coefficients.newton", impact.newton, 1.0);
    check("coefficients.poisson", impact.poisson, 1.0);
    check("coefficients.energetic", impact.energetic, 1.0);
    check("coefficients.tangential", impact.tangential, friction);
  }
  EXPECT_GT(compared, 8000);
}

TEST(CertifiedDoublesTest, EverySystemHasTheNumbersOfItsOutcome) {
  std::vector<System> systems = {Pendulum{1.0, 0.3, 1.0, -1.0}};
  for (const System& system : Systems()) {
    // Certificates take no mechanism, whose numbers have errors of their own.
    if (TangentialDirections(system) == 1 && !std::holds_alternative<Mechanism>(system)) systems.push_back(system);
    // Slip of Contact() stops just where restitution ends, which changes nothing: a plan may leave it out.
    if (auto* const contact = std::get_if<PlanarContact>(&systems.back())) contact->tangential_m_s = 0.75;
  }
  ASSERT_EQ(systems.size(), 5U);
  for (const System& system : systems) {
    SCOPED_TRACE(system.index());
    const absl::StatusOr<SolveResponse> response = LocalSolver().Solve({.scene = With(system), .certified_digits = 30});
    ASSERT_TRUE(response.ok()) << response.status();
    ASSERT_TRUE(response->outcome.certificate.has_value());
    const Certificate& certificate = *response->outcome.certificate;
    EXPECT_EQ(certificate.digits, 30);
    EXPECT_EQ(certificate.regimes, std::vector<Regime>{response->outcome.regime});
    size_t next = 0;
    VisitOutcomeNumbers(response->outcome, [&](const NumberPath& path, double value) {
      const std::string text = path.Text();
      const bool is_impact =
          text.rfind("effective", 0) != 0 && text.rfind("accuracy", 0) != 0 && text.rfind("errors.", 0) != 0;
      if (!is_impact) return;
      ASSERT_LT(next, certificate.numbers.size());
      EXPECT_EQ(certificate.numbers[next].path, text);
      EXPECT_NEAR(certificate.numbers[next].value, value, 1e-13 * std::max(1.0, std::fabs(value))) << text;
      ++next;
    });
    EXPECT_EQ(next, certificate.numbers.size());
  }
}

// --- Ties and thresholds ---

Regime CertifiedRegime(const Scene& scene) {
  const absl::StatusOr<Certificate> certificate = CertifySolve(scene, {5}, Never);
  EXPECT_TRUE(certificate.ok()) << certificate.status();
  if (!certificate.ok()) return Regime::kUnspecified;
  EXPECT_FALSE(certificate->is_set);
  EXPECT_EQ(certificate->regimes.size(), 1U);
  return certificate->regimes[0];
}

TEST(CertifiedTiesTest, APendulumLocksFromXOneOnToTheLastUlp) {
  const auto regime = [](double mu) {
    return CertifiedRegime(SceneOf(pendulum::Problem{
        .inertia = 1.0, .a = 0.5, .b = -2.0, .omega_minus = -1.0, .mu = mu, .mu_static = mu, .coefficient = 1.0}));
  };
  EXPECT_EQ(regime(0.25), Regime::kLocked);
  EXPECT_EQ(regime(std::nextafter(0.25, 1.0)), Regime::kLocked);
  EXPECT_EQ(regime(std::nextafter(0.25, 0.0)), Regime::kRebound);
}

// One rounding, of the exact difference, cannot change its sign.
TEST(CertifiedTiesTest, WhetherAPendulumLocksIsTheSignOfTheExactDifference) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(0.1, 10.0);
  int locked = 0;
  for (int i = 0; i < 1000; ++i) {
    const double a = uniform(random);
    const double b = uniform(random);
    const double mu = a / b;
    const bool locks = std::fma(mu, b, -a) >= 0.0;
    locked += locks ? 1 : 0;
    EXPECT_EQ(CertifiedRegime(SceneOf(pendulum::Problem{
                  .inertia = 1.0, .a = a, .b = b, .omega_minus = -1.0, .mu = mu, .mu_static = mu, .coefficient = 0.5})),
              locks ? Regime::kLocked : Regime::kRebound);
  }
  EXPECT_GT(locked, 300);
  EXPECT_LT(locked, 900);
}

// u and v both vanish at tau = 1 where u0 = 1.
planar::Problem StopAtRest(double u0, double eta) {
  return {.w = {2.0, 0.0, 1.0}, .u0 = u0, .v0 = -1.0, .mu = 0.5, .mu_static = 0.5, .coefficient = eta};
}

TEST(CertifiedTiesTest, SlipThatStopsJustWhereCompressionEndsStopsInRestitution) {
  EXPECT_EQ(CertifiedRegime(SceneOf(StopAtRest(1.0, 0.5))), Regime::kStickInRestitution);
  EXPECT_EQ(CertifiedRegime(SceneOf(StopAtRest(1.0, 0.0))), Regime::kStickInRestitution);
  EXPECT_EQ(CertifiedRegime(SceneOf(StopAtRest(std::nextafter(1.0, 0.0), 0.5))), Regime::kStickInCompression);
  EXPECT_EQ(CertifiedRegime(SceneOf(StopAtRest(std::nextafter(1.0, 2.0), 0.0))), Regime::kSliding);
}

// Elastic: v is back to 1 and u down to 0 at tau = 2.
TEST(CertifiedTiesTest, SlipThatStopsJustWhereEnergeticRestitutionEndsStopsBeforeIt) {
  EXPECT_EQ(CertifiedRegime(SceneOf(StopAtRest(2.0, 1.0))), Regime::kStickInRestitution);
  EXPECT_EQ(CertifiedRegime(SceneOf(StopAtRest(std::nextafter(2.0, 0.0), 1.0))), Regime::kStickInRestitution);
  EXPECT_EQ(CertifiedRegime(SceneOf(StopAtRest(std::nextafter(2.0, 3.0), 1.0))), Regime::kSliding);
  EXPECT_EQ(
      DecimalAt(*CertifySolve(SceneOf(StopAtRest(2.0, 1.0)), {40}, Never), "contact_velocity_after.tangential_m_s[0]"),
      "0");
}

TEST(CertifiedTiesTest, ContactThatHasStoppedSticksFromTheThresholdOnToTheLastUlp) {
  const auto regime = [](double mu) {
    return CertifiedRegime(SceneOf(
        planar::Problem{.w = {2.0, 1.0, 2.0}, .u0 = -1.0, .v0 = -2.0, .mu = mu, .mu_static = mu, .coefficient = 0.5}));
  };
  EXPECT_EQ(regime(0.5), Regime::kStickInCompression);
  EXPECT_EQ(regime(std::nextafter(0.5, 0.0)), Regime::kReversalInCompression);
}

// W = [1, 3; 3, 9] has rank one; its neighbours are of rank two, or no W at all.
TEST(CertifiedTiesTest, ARankOfOneIsThatOfTheDoublesThemselves) {
  planar::Problem problem = {.w = {1.0, 3.0, 9.0}, .u0 = -1.0, .v0 = -3.0, .mu = 0.25, .mu_static = 3.0};
  problem.coefficient = 0.5;
  EXPECT_EQ(CertifiedRegime(SceneOf(problem)), Regime::kLocked);
  problem.w.tn = std::nextafter(3.0, 0.0);
  EXPECT_NE(CertifiedRegime(SceneOf(problem)), Regime::kLocked);
  problem.w.tn = std::nextafter(3.0, 4.0);
  EXPECT_EQ(CertifySolve(SceneOf(problem), {5}, Never).status().message(),
            "planar_contact.w_tn_per_kg makes det W < 0: must leave it >= 0 exactly, not to rounding, with "
            "certified_digits");
  problem.w.tn = 3.0;
  problem.u0 = std::nextafter(-1.0, 0.0);
  EXPECT_EQ(CertifySolve(SceneOf(problem), {5}, Never).status().message(),
            "planar_contact.tangential_m_s makes (u0, v0) lie beside the range of W, whose rank is one: must lie in it "
            "exactly, not to rounding, for a certified answer, which knows no impact of this kind");
}

// --- Digits ---

std::vector<Scene> Various() {
  planar::SceneSource contacts(5);
  pendulum::SceneSource pendulums(5);
  std::vector<Scene> scenes = {With(Chain())};
  for (int i = 0; i < 20; ++i) {
    scenes.push_back(SceneOf(pendulums.OverAllDoubles()));
    scenes.push_back(SceneOf(contacts.Everyday()));
  }
  return scenes;
}

TEST(CertifiedDigitsTest, FourHundredDigitsBeginWithTwoHundred) {
  for (const Scene& scene : Various()) {
    const absl::StatusOr<Certificate> some = CertifySolve(scene, {200}, Never);
    const absl::StatusOr<Certificate> more = CertifySolve(scene, {400}, Never);
    ASSERT_TRUE(some.ok() && more.ok());
    ASSERT_EQ(some->numbers.size(), more->numbers.size());
    for (size_t i = 0; i < some->numbers.size(); ++i) {
      EXPECT_TRUE(Agree(more->numbers[i].decimal, some->numbers[i].decimal, 199)) << some->numbers[i].path;
      EXPECT_EQ(some->numbers[i].value, more->numbers[i].value) << some->numbers[i].path;
    }
  }
}

TEST(CertifiedDigitsTest, AThousandDigitsOfARootAreThoseWhoseSquareIsTheRatio) {
  const Scene scene = SceneOf(pendulum::Problem{
      .inertia = 1.0, .a = 3.0, .b = 1.0, .omega_minus = -1.0, .mu = 1.0, .mu_static = 1.0, .coefficient = 1.0});
  const std::string newton = DecimalAt(*CertifySolve(scene, {1000}, Never), "coefficients.newton");
  ASSERT_EQ(newton.size(), 1002U);  // "0." before the digits.
  const Ball root = Digits(newton);
  const Ball unit = Digits("1e-1000");
  const Ball half(0.5);
  EXPECT_TRUE((root - half * unit) * (root - half * unit) < half);
  EXPECT_TRUE((root + half * unit) * (root + half * unit) > half);
}

TEST(CertifiedDigitsTest, WhatIsExactSaysSo) {
  const Scene scene = SceneOf(pendulum::Problem{
      .inertia = 1.0, .a = 3.0, .b = 1.0, .omega_minus = -1.0, .mu = 1.0, .mu_static = 1.0, .coefficient = 0.5});
  const Certificate certificate = *CertifySolve(scene, {10}, Never);
  const CertifiedNumber impulse = NumberAt(certificate, "impulse.normal_compression_n_s");
  EXPECT_EQ(impulse.decimal, "0.25");
  EXPECT_TRUE(impulse.exact);
  const CertifiedNumber newton = NumberAt(certificate, "coefficients.newton");
  EXPECT_EQ(newton.decimal, "0.3535533906");
  EXPECT_FALSE(newton.exact);
  const CertifiedNumber spring = NumberAt(certificate, "work.tangential_spring_j");
  EXPECT_EQ(spring.decimal, "0");
  EXPECT_TRUE(spring.exact);
}

// v1 = 0.5 and 1.5 m/s to one digit: the middle of two goes to the even one.
TEST(CertifiedDigitsTest, DigitsAreRoundedToTheNearestAndHalvesToEven) {
  const auto after = [](double v0, int digits) {
    return DecimalAt(
        *CertifySolve(SceneOf(planar::Problem{.w = {1.0, 0.0, 1.0}, .v0 = -v0, .coefficient = 1.0}), {digits}, Never),
        "contact_velocity_after.normal_m_s");
  };
  EXPECT_EQ(after(2.5, 1), "2");
  EXPECT_EQ(after(3.5, 1), "4");
  EXPECT_EQ(after(9.5, 1), "1e1");
  EXPECT_EQ(after(9.96, 2), "10");
  EXPECT_EQ(after(9.94, 2), "9.9");
  EXPECT_EQ(after(0x1p-1074, 5), "4.9407e-324");
  EXPECT_EQ(after(1e22, 23), "10000000000000000000000");
  EXPECT_EQ(after(1e22, 5), "1e22");
  EXPECT_EQ(after(0.0001220703125, 5), "0.00012207");
}

// The middle of two doubles, and just beyond it.
TEST(CertifiedDigitsTest, TheValueIsTheNearestDouble) {
  const auto value = [](double e, double v0) {
    planar::Problem problem = {.w = {1.0, 0.0, 1.0}, .v0 = -v0, .law = RestitutionLaw::kNewton, .coefficient = e};
    return NumberAt(*CertifySolve(SceneOf(problem), {3}, Never), "contact_velocity_after.normal_m_s").value;
  };
  EXPECT_EQ(value(0.5, 0x3p-1074), 0x2p-1074);
  EXPECT_EQ(value(0.5, 0x1p-1074), 0.0);
  EXPECT_EQ(value(std::nextafter(0.5, 1.0), 0x1p-1074), 0x1p-1074);
  EXPECT_EQ(value(3.0, 1e308), kInfinity);
  EXPECT_EQ(value(0.1, 3.0), 0.1 * 3.0);
}

}  // namespace
}  // namespace ricochet
