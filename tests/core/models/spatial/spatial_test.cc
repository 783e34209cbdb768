#include "core/models/spatial/spatial.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/models/planar/planar.h"
#include "core/models/restitution_law.h"
#include "core/models/spatial/solver-inl.h"
#include "tests/support/claims/spatial_claims.h"
#include "tests/support/scenes/known_contacts.h"
#include "tests/support/scenes/spatial_contact.h"
#include "tests/support/scenes/spatial_scenes.h"

namespace ricochet::spatial {
namespace {

// Solves with 64-bit mantissas to a tolerance of 1e-16.
Impact Reference(const Problem& problem) {
  return HWY_NAMESPACE::Solver<long double>(problem, problem.Delassus().Rank(), 1e-16L).Run();
}

double Scale(const Problem& problem) {
  return std::max(std::hypot(problem.u0[0], problem.u0[1]), std::fabs(problem.v0));
}

// The largest difference of a velocity after the impact over max(|u0|, |v0|).
double Distance(const Problem& problem, const Impact& a, const Impact& b) {
  return std::max(std::hypot(a.u1[0] - b.u1[0], a.u1[1] - b.u1[1]), std::fabs(a.v1 - b.v1)) / Scale(problem);
}

// A contact and four of its impacts were computed independently at 25 digits.
Problem Known(double u1, double u2, double mu) {
  Problem problem = TurningContact(u1, u2, mu);
  problem.law = RestitutionLaw::kEnergetic;
  problem.coefficient = 0.6;
  problem.tolerance = 1e-12;
  return problem;
}

struct KnownImpact {
  const char* name;
  Problem problem;
  double u1, u2, v1;
  Regime regime;
};
const KnownImpact kKnownImpacts[] = {
    {"Mu2", Known(1.0, 0.6, 0.2), 1.1935907812616, -0.23674642666214, 0.58574780070097, Regime::kSliding},
    {"Mu4", Known(1.0, 0.6, 0.4), 0.8464137913066, -0.30730421739091, 0.56534880484974, Regime::kSliding},
    {"Mu9", Known(1.0, 0.6, 0.9), 0.0, 0.0, 0.56781213107787, Regime::kStickInRestitution},
    {"NearMiss", Known(-.15231670063190971, .25845622977326199, 0.2), 0.2566352273718, -0.2771032621575,
     0.5606160735658, Regime::kSliding},
};

class KnownImpactTest : public testing::TestWithParam<KnownImpact> {};

TEST_P(KnownImpactTest, IsReproduced) {
  const KnownImpact& known = GetParam();
  const Impact impact = Solve(known.problem);
  EXPECT_EQ(impact.regime, known.regime);
  EXPECT_NEAR(impact.u1[0], known.u1, 1e-12);
  EXPECT_NEAR(impact.u1[1], known.u2, 1e-12);
  EXPECT_NEAR(impact.v1, known.v1, 1e-12);
  EXPECT_LE(impact.error_estimate, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(SpatialTest, KnownImpactTest, testing::ValuesIn(kKnownImpacts),
                         [](const auto& test) { return std::string(test.param.name); });

// Integrates Keller's equations as they stand, d/dtau of (u, v, normal work), by the classical Runge-Kutta method at a
// fixed step. It shares nothing with the solver, and is accurate as long as slip stays away from 0.
class PlainIntegrator {
 public:
  explicit PlainIntegrator(const Problem& problem)
      : p_(problem), state_{problem.u0[0], problem.u0[1], problem.v0, 0.0L} {}

  // Runs to the state at which `goal` is reached, by bisecting the last step.
  template <typename Goal>
  void RunTo(long double step, const Goal& goal) {
    while (!goal(Stepped(step))) state_ = Stepped(step);
    long double low = 0.0L;
    for (int i = 0; i < 64; ++i) {
      step *= 0.5L;
      if (!goal(Stepped(low + step))) low += step;
    }
    state_ = Stepped(low);
  }

  struct State {
    long double u1, u2, v, work;
  };
  const State& state() const { return state_; }
  void ForgetWork() { state_.work = 0.0L; }

 private:
  State Rate(const State& at) const {
    const long double s = std::sqrt(at.u1 * at.u1 + at.u2 * at.u2);
    const long double f1 = -p_.mu * at.u1 / s;
    const long double f2 = -p_.mu * at.u2 / s;
    return {p_.w11 * f1 + p_.w12 * f2 + p_.w13, p_.w12 * f1 + p_.w22 * f2 + p_.w23, p_.w13 * f1 + p_.w23 * f2 + p_.w33,
            at.v};
  }
  static State Sum(const State& a, long double t, const State& b) {
    return {a.u1 + t * b.u1, a.u2 + t * b.u2, a.v + t * b.v, a.work + t * b.work};
  }
  State Stepped(long double step) const {
    const State k1 = Rate(state_);
    const State k2 = Rate(Sum(state_, step / 2, k1));
    const State k3 = Rate(Sum(state_, step / 2, k2));
    const State k4 = Rate(Sum(state_, step, k3));
    return Sum(Sum(Sum(Sum(state_, step / 6, k1), step / 3, k2), step / 3, k3), step / 6, k4);
  }

  Problem p_;
  State state_;
};

TEST(SpatialTest, AgreesWithKellersEquationsIntegratedPlainly) {
  SceneSource source(1);
  int compared = 0;
  double worst = 0.0;
  while (compared < 100) {
    Problem problem = source.Typical();
    problem.law = RestitutionLaw::kEnergetic;
    problem.tolerance = 1e-12;
    const Impact impact = Solve(problem);
    if (impact.regime != Regime::kSliding || problem.mu * std::hypot(problem.w13, problem.w23) > problem.w33) continue;
    double slip = std::numeric_limits<double>::infinity();
    for (int i = 0; i < impact.event_count; ++i) {
      slip = std::min(
          slip, std::hypot(impact.events[static_cast<size_t>(i)].u[0], impact.events[static_cast<size_t>(i)].u[1]));
    }
    if (slip < 0.3) continue;
    const long double step = impact.tau1 / 4000.0L;
    PlainIntegrator plain(problem);
    plain.RunTo(step, [](const auto& state) { return state.v >= 0.0L; });
    const long double target =
        -static_cast<long double>(problem.coefficient) * problem.coefficient * plain.state().work;
    plain.ForgetWork();
    plain.RunTo(step, [&](const auto& state) { return state.work >= target; });
    const double error = std::max({std::fabs(static_cast<double>(plain.state().u1) - impact.u1[0]),
                                   std::fabs(static_cast<double>(plain.state().u2) - impact.u1[1]),
                                   std::fabs(static_cast<double>(plain.state().v) - impact.v1)});
    EXPECT_LT(error, 1e-10);
    worst = std::max(worst, error);
    ++compared;
  }
  std::printf("  worst difference %.2e\n", worst);
}

struct Statistics {
  double worst_ratio = std::numeric_limits<double>::infinity();
  double median_ratio = 0.0;
  double worst_error = 0.0;
  int above_tolerance = 0;
};

// The ratio of the error estimate to the true error. A true error below the rounding of the output counts as that
// rounding.
template <typename NextProblem>
Statistics EstimateStatistics(double tolerance, int count, const NextProblem& next_problem) {
  constexpr double kRounding = 0x1p-54;
  Statistics statistics;
  std::vector<double> ratios;
  for (int i = 0; i < count; ++i) {
    Problem problem = next_problem();
    problem.tolerance = tolerance;
    const Impact impact = Solve(problem);
    const double error = Distance(problem, impact, Reference(problem));
    ratios.push_back(impact.error_estimate / std::max(error, kRounding));
    statistics.worst_error = std::max(statistics.worst_error, error);
    statistics.above_tolerance += error > tolerance ? 1 : 0;
  }
  std::sort(ratios.begin(), ratios.end());
  statistics.worst_ratio = ratios.front();
  statistics.median_ratio = ratios[ratios.size() / 2];
  return statistics;
}

class EstimateTest : public testing::TestWithParam<double> {
 protected:
  static constexpr int kCount = 10000;

  static void Check(const char* what, const Statistics& statistics) {
    std::printf("  %s: estimate/error at least %.2f, median %.1f; largest error %.1e for a tolerance of %.0e\n", what,
                statistics.worst_ratio, statistics.median_ratio, statistics.worst_error, GetParam());
    EXPECT_GE(statistics.worst_ratio, 1.0);
    EXPECT_LE(statistics.median_ratio, 12.0);
  }
};

TEST_P(EstimateTest, IsNeverBelowTheErrorOfTypicalImpactsWhichIsWithinTheTolerance) {
  SceneSource source(11);
  const Statistics statistics = EstimateStatistics(GetParam(), kCount, [&] { return source.Typical(); });
  Check("typical", statistics);
  EXPECT_EQ(statistics.above_tolerance, 0);
}

TEST_P(EstimateTest, IsNeverBelowTheErrorOfNearlySingularImpacts) {
  SceneSource source(12);
  Check("nearly singular", EstimateStatistics(GetParam(), kCount, [&] { return source.NearSingular(); }));
}

INSTANTIATE_TEST_SUITE_P(SpatialTest, EstimateTest, testing::Values(1e-4, 1e-6, 1e-10, 1e-12));

// Slip follows its invariant direction (p, q) from the start, and v' goes from everyday size down to 1e-4 Wnn.
Problem StraightAndNearlyJamming(SceneSource& source, double p, double q) {
  Problem problem = source.Typical();
  problem.w12 = 0.0;
  if (p != 0.0) problem.w22 = problem.w11;
  // The numbers have few bits, so that wtn and u0 are exactly along (p, q).
  const double coupling = std::ldexp(std::floor(std::ldexp(source.Uniform(0.1, 0.6), 20)), -20);
  const double slip = std::ldexp(std::floor(std::ldexp(std::exp2(source.Uniform(-3.0, 7.0)), 20)), -20);
  problem.w13 = coupling * p;
  problem.w23 = coupling * q;
  problem.u0 = {slip * p, slip * q};
  const double critical = problem.w33 / (coupling * std::hypot(p, q));
  problem.mu = problem.mu_static = critical * (1.0 - std::pow(10.0, -source.Uniform(0.1, 4.0)));
  problem.tolerance = kLeastTolerance;
  return problem;
}

TEST(SpatialTest, EstimateOfAClosedFormIsNotBelowItsErrorHoweverSlowlyVGrows) {
  SceneSource source(13);
  double least = std::numeric_limits<double>::infinity();
  std::vector<double> ratios;
  for (int i = 0; i < 60'000; ++i) {
    const bool oblique = i % 2 == 0;
    const Problem problem =
        oblique ? StraightAndNearlyJamming(source, 3.0, 1.0) : StraightAndNearlyJamming(source, 0.0, 1.0);
    const Impact impact = Solve(problem);
    ASSERT_TRUE(impact.closed_form) << i;
    Problem second = problem;  // The plane of t2 and n has an exact model.
    second.w11 = problem.w22;
    second.w13 = problem.w23;
    second.u0 = {problem.u0[1], 0.0};
    const planar::Impact planar = planar::Solve(InPlane(second));
    Impact reference;
    reference.u1 = {0.0, planar.u1};
    reference.v1 = planar.v1;
    if (oblique) reference = Reference(problem);
    const double ratio = impact.error_estimate / std::max(Distance(problem, impact, reference), 0x1p-54);
    ASSERT_GE(ratio, 1.0) << i << " v0 " << problem.v0 << " estimate " << impact.error_estimate;
    ratios.push_back(ratio);
    least = std::min(least, ratio);
  }
  std::nth_element(ratios.begin(), ratios.begin() + 30'000, ratios.end());
  std::printf("  estimate/error at least %.2f, median %.1f\n", least, ratios[30'000]);
  EXPECT_LE(ratios[30'000], 30.0);
}

TEST(SpatialTest, SlipThatStartsAtNearlyNoRateEnds) {
  SceneSource source(14);
  for (int i = 0; i < 10'000; ++i) {
    Problem problem = source.Typical();
    problem.mu = problem.mu_static = SceneSource::StickFriction(problem) * (1.0 - std::ldexp(1.0, -50 + i % 20));
    if (i % 2 == 0) problem.u0 = {};
    const Impact impact = Solve(problem);
    ASSERT_TRUE(impact.Converged()) << i;
    ASSERT_LE(impact.event_count, 4) << i;
    ASSERT_EQ(impact.events[static_cast<size_t>(impact.event_count) - 1].kind, EventKind::kRestitutionEnds) << i;
  }
}

TEST(SpatialTest, EveryImpactEndsConservesTheLedgerStaysInTheConeAndGainsNoEnergyUnderTheEnergeticLaw) {
  SceneSource source(21);
  int64_t most_steps = 0;
  for (int i = 0; i < 100000; ++i) {
    Problem problem = i % 2 == 0 ? source.Typical() : source.NearSingular();
    problem.tolerance = 1e-6;
    const Impact impact = Solve(problem);
    ASSERT_TRUE(impact.Converged()) << i;
    ASSERT_TRUE(std::isfinite(impact.error_estimate)) << i;
    most_steps = std::max(most_steps, impact.steps);
    const double f1 = std::hypot(impact.f1[0], impact.f1[1]);
    // The works of the impulses count before they cancel.
    const double scale = Scale(problem) * (impact.tau1 + f1) + std::fabs(impact.work_tangential_compression) +
                         (problem.w11 + problem.w22 + problem.w33) * (impact.tau1 + f1) * (impact.tau1 + f1);
    const double ledger = impact.work_normal_compression + impact.work_normal_restitution +
                          impact.work_tangential_compression + impact.work_tangential_restitution;
    ASSERT_NEAR(ledger, impact.energy_change, 1e-13 * scale) << i;
    ASSERT_LE(f1, problem.mu * impact.tau1 * (1.0 + 1e-5)) << i;
    ASSERT_LE(impact.work_tangential_compression, 0.0) << i;
    ASSERT_LE(impact.work_tangential_restitution, 1e-15 * scale) << i;
    if (problem.law != RestitutionLaw::kEnergetic) continue;
    ASSERT_FALSE(impact.sharp_limit_broken) << i;
    ASSERT_FALSE(impact.energy_limit_broken) << i;
    ASSERT_LE(impact.energy_change, impact.error_estimate * scale) << i;
  }
  std::printf("  at most %ld steps\n", static_cast<long>(most_steps));
  EXPECT_LE(most_steps, 500);
}

TEST(SpatialTest, VelocitiesAreThoseThatTheImpulsesLeadTo) {
  SceneSource source(22);
  for (int i = 0; i < 10000; ++i) {
    Problem p = source.Typical();
    p.tolerance = 1e-6;
    const Impact impact = Solve(p);
    const double f1 = impact.f1[0];
    const double f2 = impact.f1[1];
    const double scale = 1e-13 * (Scale(p) + (p.w11 + p.w22 + p.w33) * impact.tau1);
    ASSERT_NEAR(impact.u1[0], p.u0[0] + p.w11 * f1 + p.w12 * f2 + p.w13 * impact.tau1, scale) << i;
    ASSERT_NEAR(impact.u1[1], p.u0[1] + p.w12 * f1 + p.w22 * f2 + p.w23 * impact.tau1, scale) << i;
    ASSERT_NEAR(impact.v1, p.v0 + p.w13 * f1 + p.w23 * f2 + p.w33 * impact.tau1, scale) << i;
  }
}

TEST(SpatialTest, IsThePlanarModelWhereOneDirectionDecouples) {
  SceneSource source(23);
  for (int i = 0; i < 10000; ++i) {
    Problem p = source.Typical();
    p.w12 = p.w23 = 0.0;
    p.u0[1] = 0.0;
    if (i % 10 == 0) p.u0[0] = 0.0;
    if (i % 3 == 0) p.mu_static = p.mu * 1.5;
    const Impact impact = Solve(p);
    const planar::Impact planar = planar::Solve(InPlane(p));
    const double velocity = 1e-11 * Scale(p);
    ASSERT_TRUE(impact.closed_form) << i;
    ASSERT_EQ(impact.regime, planar.regime) << i;
    ASSERT_NEAR(impact.u1[0], planar.u1, velocity) << i;
    ASSERT_EQ(impact.u1[1], 0.0) << i;
    ASSERT_NEAR(impact.v1, planar.v1, velocity) << i;
    ASSERT_NEAR(impact.tau1, planar.tau1, 1e-11 * planar.tau1) << i;
    ASSERT_NEAR(impact.energetic, planar.energetic, 1e-9) << i;
    ASSERT_EQ(impact.event_count, planar.event_count) << i;
  }
}

// However heavy the contact is along one direction, it sticks where a contact in that plane would, and a smooth surface
// holds nothing.
TEST(SpatialTest, IsThePlanarModelWhereOneDirectionIsHeavy) {
  SceneSource source(31);
  for (int i = 0; i < 2000; ++i) {
    Problem p = source.Typical();
    const int heavy = i % 200;
    const double scale = std::pow(10.0, -std::max((heavy + 1) / 2, 7 * i % 200));
    p.w11 *= std::pow(10.0, -heavy);
    p.w13 *= scale;
    p.w12 = p.w23 = 0.0;
    p.u0 = {0.0, 0.0};
    const double critical = std::fabs(p.w13) / p.w11;
    p.mu = std::array{0.0, p.mu, 0.99 * critical, 1.01 * critical}[static_cast<size_t>(i % 4)];
    p.mu_static = p.mu;
    const Impact impact = Solve(p);
    const planar::Impact planar = planar::Solve(InPlane(p));
    ASSERT_EQ(impact.regime, planar.regime) << i << " W11 " << p.w11 << " W13 " << p.w13 << " mu " << p.mu;
    ASSERT_NEAR(impact.u1[0], planar.u1, 1e-11 * Scale(p)) << i;
    ASSERT_EQ(impact.u1[1], 0.0) << i;
    ASSERT_NEAR(impact.v1, planar.v1, 1e-11 * Scale(p)) << i;
    ASSERT_NEAR(impact.f1[0], planar.f1, 1e-11 * std::max(std::fabs(planar.f1), planar.tau1)) << i;
    if (p.mu == 0.0) {
      ASSERT_EQ(impact.f1[0], 0.0) << i;
    }
  }
}

// However light the contact is along one direction, friction stops it there at once, and the rest is planar.
TEST(SpatialTest, IsThePlanarModelWhereOneDirectionHasNoInertia) {
  SceneSource source(29);
  for (int i = 0; i < 1000; ++i) {
    Problem p = source.Typical();
    Problem across = p;
    across.w11 = p.w22;
    across.w13 = p.w23;
    across.w12 = across.w23 = 0.0;
    across.u0 = {p.u0[1], 0.0};
    const planar::Impact planar = planar::Solve(InPlane(across));
    p.w11 *= std::pow(10.0, 30 + i % 70);
    const Impact impact = Solve(p);
    const double velocity = 1e-11 * Scale(across);
    ASSERT_EQ(impact.regime, planar.regime) << i;
    ASSERT_NEAR(impact.u1[0], 0.0, velocity) << i;
    ASSERT_NEAR(impact.u1[1], planar.u1, velocity) << i;
    ASSERT_NEAR(impact.v1, planar.v1, velocity) << i;
    ASSERT_GE(impact.error_estimate * Scale(p), std::fabs(impact.v1 - planar.v1)) << i;
  }
}

// Turns the tangent frame of a contact by the angle of (c, s).
Problem Turned(const Problem& p, double c, double s) {
  Problem turned = p;
  turned.w11 = c * c * p.w11 + 2.0 * c * s * p.w12 + s * s * p.w22;
  turned.w22 = s * s * p.w11 - 2.0 * c * s * p.w12 + c * c * p.w22;
  turned.w12 = c * s * (p.w22 - p.w11) + (c * c - s * s) * p.w12;
  turned.w13 = c * p.w13 + s * p.w23;
  turned.w23 = c * p.w23 - s * p.w13;
  turned.u0 = {c * p.u0[0] + s * p.u0[1], c * p.u0[1] - s * p.u0[0]};
  return turned;
}

TEST(SpatialTest, AnotherTangentFrameChangesNothing) {
  SceneSource source(24);
  for (int i = 0; i < 10000; ++i) {
    Problem problem = source.Typical();
    problem.tolerance = 1e-9;
    const double angle = source.Uniform(0.0, 6.3);
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const Impact impact = Solve(problem);
    Impact turned = Solve(Turned(problem, c, s));
    turned.u1 = {c * turned.u1[0] - s * turned.u1[1], s * turned.u1[0] + c * turned.u1[1]};
    ASSERT_LE(Distance(problem, impact, turned), 2e-9) << i;
    ASSERT_EQ(impact.regime, turned.regime) << i;
  }
}

TEST(SpatialTest, PowersOfTwoOfTheUnitsChangeNoBit) {
  SceneSource source(25);
  for (const int shift : {-700, -300, 300, 700}) {
    const Problem problem = source.Typical();
    Problem scaled = problem;
    for (double* w : {&scaled.w11, &scaled.w12, &scaled.w13, &scaled.w22, &scaled.w23, &scaled.w33}) {
      *w = std::ldexp(*w, shift);
    }
    for (double* v : {&scaled.u0[0], &scaled.u0[1], &scaled.v0}) *v = std::ldexp(*v, shift);
    EXPECT_EQ(Solve(scaled).v1, std::ldexp(Solve(problem).v1, shift));
    EXPECT_EQ(Solve(scaled).u1[0], std::ldexp(Solve(problem).u1[0], shift));
    EXPECT_EQ(Solve(scaled).tau1, Solve(problem).tau1);
  }
}

TEST(SpatialTest, AContactThatDoesNotApproachIsLeftAlone) {
  for (const double v0 : {0.0, 0.5}) {
    Problem problem = Known(1.0, 0.6, 0.2);
    problem.v0 = v0;
    const Impact impact = Solve(problem);
    EXPECT_EQ(impact.regime, Regime::kSeparating);
    EXPECT_EQ(impact.u1, problem.u0);
    EXPECT_EQ(impact.v1, v0);
    EXPECT_EQ(impact.tau1, 0.0);
    EXPECT_EQ(impact.event_count, 0);
    EXPECT_EQ(impact.w_rank, 3);
  }
}

TEST(SpatialTest, WithoutFrictionTheThreeLawsAgree) {
  for (const RestitutionLaw law : {RestitutionLaw::kNewton, RestitutionLaw::kPoisson, RestitutionLaw::kEnergetic}) {
    Problem problem = Known(1.0, 0.6, 0.0);
    problem.law = law;
    const Impact impact = Solve(problem);
    EXPECT_EQ(impact.regime, Regime::kFrictionless);
    EXPECT_TRUE(impact.closed_form);
    EXPECT_NEAR(impact.v1, 0.6, 1e-15);
    EXPECT_NEAR(impact.u1[0], 1.0 + 0.6 * 1.6 / 1.85, 1e-15);
    EXPECT_NEAR(impact.u1[1], 0.6 - 0.8 * 1.6 / 1.85, 1e-15);
    EXPECT_NEAR(impact.newton, 0.6, 1e-15);
    EXPECT_NEAR(impact.poisson, 0.6, 1e-15);
    EXPECT_NEAR(impact.energetic, 0.6, 1e-15);
  }
}

// A sphere has a Wtt of 7/2 Wnn in every direction and no coupling, so that slip never turns.
Problem Sphere(double u1, double u2) {
  return Contact({3.5, 0.0, 0.0, 3.5, 0.0, 1.0}, {u1, u2}, -1.0, 0.1, {.coefficient = 1.0});
}

TEST(SpatialTest, AFastSphereSlidesAgainstItsWholeImpulse) {
  const Impact impact = Solve(Sphere(3.0, 4.0));
  EXPECT_EQ(impact.regime, Regime::kSliding);
  EXPECT_TRUE(impact.closed_form);
  EXPECT_NEAR(impact.u1[0], 3.0 - 0.6 * 0.7, 1e-14);
  EXPECT_NEAR(impact.u1[1], 4.0 - 0.8 * 0.7, 1e-14);
  EXPECT_NEAR(impact.v1, 1.0, 1e-15);
  EXPECT_NEAR(impact.tangential, 0.1, 1e-16);
}

TEST(SpatialTest, ASlowSphereEndsRolling) {
  const Impact in_compression = Solve(Sphere(0.03, 0.04));
  EXPECT_EQ(in_compression.regime, Regime::kStickInCompression);
  EXPECT_EQ(in_compression.u1[0], 0.0);
  const Impact in_restitution = Solve(Sphere(0.3, 0.4));
  EXPECT_EQ(in_restitution.regime, Regime::kStickInRestitution);
  EXPECT_NEAR(in_restitution.f1[0], -0.3 / 3.5, 1e-15);
  EXPECT_EQ(in_restitution.event_count, 4);
  EXPECT_EQ(in_restitution.events[2].kind, EventKind::kSlipStops);
  EXPECT_NEAR(in_restitution.events[2].tau, 0.5 / 0.35, 1e-14);
}

TEST(SpatialTest, SlipThatStopsStartsAgainAlongTheGrowingDirection) {
  // Slip straight against wtn stops at tau = 0.1/0.7, then slips along +t1 with h = 0.5 - 0.2.
  Problem problem = Contact({1.0, 0.0, 0.5, 2.0, 0.0, 1.0}, {-0.1, 0.0}, -1.0, 0.2,
                            {.law = RestitutionLaw::kPoisson, .coefficient = 0.0});
  Impact impact = Solve(problem);
  EXPECT_EQ(impact.regime, Regime::kReversalInCompression);
  const double stop = 0.1 / 0.7;
  const double end = stop + (1.0 - 1.1 * stop) / 0.9;
  EXPECT_NEAR(impact.tau1, end, 1e-14);
  EXPECT_NEAR(impact.u1[0], 0.3 * (end - stop), 1e-14);
  problem.u0[0] = -0.7;
  problem.coefficient = 1.0;
  impact = Solve(problem);
  EXPECT_EQ(impact.regime, Regime::kReversalInRestitution);
  EXPECT_NEAR(impact.u1[0], 0.3 * (impact.tau1 - 1.0), 1e-14);
}

TEST(SpatialTest, ARestartKeepsToTheInvariantDirection) {
  Problem problem = Known(0.0, 0.0, 0.2);
  const Impact impact = Solve(problem);
  EXPECT_EQ(impact.regime, Regime::kSliding);
  EXPECT_TRUE(impact.closed_form);
  const double slip = std::hypot(impact.u1[0], impact.u1[1]);
  const double c = impact.u1[0] / slip;
  const double s = impact.u1[1] / slip;
  const double u1 = problem.w13 - problem.mu * (problem.w11 * c + problem.w12 * s);
  const double u2 = problem.w23 - problem.mu * (problem.w12 * c + problem.w22 * s);
  EXPECT_NEAR(c * u2 - s * u1, 0.0, 1e-15);
  EXPECT_GT(c * u1 + s * u2, 0.0);
}

TEST(SpatialTest, StaticFrictionDecidesWhetherStoppedSlipSticks) {
  const double critical = SceneSource::StickFriction(Known(0.0, 0.0, 0.0));
  Problem problem = Known(0.0, 0.0, 0.2);
  problem.mu_static = critical * (1.0 + 1e-12);
  EXPECT_EQ(Solve(problem).regime, Regime::kStickInCompression);
  EXPECT_EQ(Solve(problem).u1[0], 0.0);
  const double v1 = Solve(problem).v1;
  for (const double mu_static : {10.0, 1e100, 1e200, 1e300, std::numeric_limits<double>::max()}) {
    problem.mu_static = mu_static;
    EXPECT_EQ(Solve(problem).regime, Regime::kStickInCompression) << mu_static;
    EXPECT_EQ(Solve(problem).v1, v1) << mu_static;
  }
  problem.mu_static = critical * (1.0 - 1e-12);
  EXPECT_EQ(Solve(problem).regime, Regime::kSliding);
}

TEST(SpatialTest, NearMissesAreAsSmoothAsAnyOther) {
  // Slip that starts ever closer to the direction it would stop along turns round ever closer to 0.
  const double phi = std::atan2(.25845622977326199, -.15231670063190971);
  Impact before;
  for (int power = 2; power <= 14; ++power) {
    const double angle = phi + std::pow(10.0, -power);
    Problem problem = Known(0.3 * std::cos(angle), 0.3 * std::sin(angle), 0.2);
    problem.tolerance = 1e-10;
    const Impact impact = Solve(problem);
    EXPECT_EQ(impact.regime, Regime::kSliding) << power;
    EXPECT_LE(impact.error_estimate, 1e-10) << power;
    EXPECT_LE(impact.steps, 40) << power;
    EXPECT_LE(Distance(problem, impact, Reference(problem)), impact.error_estimate) << power;
    if (power > 2) {
      EXPECT_LE(Distance(problem, impact, before), std::pow(10.0, 1 - power)) << power;
    }
    before = impact;
  }
}

TEST(SpatialTest, SelfLockingAtFirstEndsOnceSlipHasStopped) {
  // The contact moves along wtn with mu |wtn| > Wnn, so that friction drives the bodies together until slip stops.
  const Problem problem = Contact({2.0, 0.1, 1.2, 1.5, 0.2, 1.0}, {1.0, 0.3}, -1.0, 1.0, {.coefficient = 0.5});
  const Impact impact = Solve(problem);
  EXPECT_EQ(impact.regime, Regime::kStickInCompression);
  ASSERT_EQ(impact.events[1].kind, EventKind::kSlipStops);
  EXPECT_LT(impact.events[1].v, -1.0);
  EXPECT_GT(impact.v1, 0.0);
  EXPECT_LE(Distance(problem, impact, Reference(problem)), 1e-10);
}

// Friction holds the contact at v = 0.125, all that Newton's coefficient asks for.
TEST(SpatialTest, AContactThatIsHeldAtTheVelocityAskedForEnds) {
  for (const double w22 : {0.0, 2.0}) {
    const Impact impact = Solve(Contact({1.0, 0.0, 0.25, w22, 0.0, 0.0625}, {-1.5, 0.0}, -0.25, 0.3,
                                        {.law = RestitutionLaw::kNewton, .coefficient = 0.5}));
    EXPECT_EQ(impact.regime, Regime::kStickInRestitution) << w22;
    EXPECT_NEAR(impact.v1, 0.125, 1e-16) << w22;
  }
}

// Keller's equations of one contact were integrated independently by a Runge-Kutta method: in restitution v grows up to
// the normal impulse 0.45255902972, and falls through 0 at 0.54817552448. Compression ends at 0.35768286173.
TEST(SpatialTest, TheEndRecedesWhereWhatEndsTheImpactBeginsToFall) {
  Problem problem = Contact({1.2367, 0.4119, -1.6898, 3.6464, -2.9784, 3.9852}, {0.8761, -0.8394}, -0.6307, 1.3465);
  struct Case {
    RestitutionLaw law;
    double before, after;  // Coefficients on both sides of the jump.
    double tau, v;         // Of the event.
  };
  const double poisson = 0.54817552448 / 0.35768286173 - 1.0;
  const Case cases[] = {
      {RestitutionLaw::kNewton, 0.0511, 0.0512, 0.45255902972, 0.03227808},
      {RestitutionLaw::kEnergetic, 0.2126, 0.2127, 0.54817552448, 0.0},
      {RestitutionLaw::kPoisson, poisson - 1e-4, poisson + 1e-4, (1.0 + poisson + 1e-4) * 0.35768286173, -2.1719e-5}};
  for (const auto& [law, before, after, tau, v] : cases) {
    problem.law = law;
    problem.coefficient = before;
    const Impact ends = Solve(problem);
    EXPECT_EQ(ends.event_count, 3);
    problem.coefficient = after;
    const Impact goes_on = Solve(problem);
    ASSERT_EQ(goes_on.event_count, 5);
    EXPECT_GT(goes_on.tau1, 10.0 * ends.tau1);
    EXPECT_EQ(goes_on.events[2].kind, EventKind::kEndRecedes);
    EXPECT_NEAR(goes_on.events[2].tau, tau, 1e-10);
    EXPECT_NEAR(goes_on.events[2].v, v, 5e-9);
  }
}

TEST(SpatialTest, RankOneIsPlanarAlongItsTangentialDirection) {
  // W = g g^T with g = (0.3, 0.4, 1) is that of a pendulum with a/|b| = 2.
  for (const double mu : {0.5, 3.0}) {
    const Problem problem = Contact({0.09, 0.12, 0.3, 0.16, 0.4, 1.0}, {-0.3, -0.4}, -1.0, mu, {.coefficient = 1.0});
    const Impact impact = Solve(problem);
    const planar::Impact planar = planar::Solve({.w = {0.25, 0.5, 1.0},
                                                 .u0 = -0.5,
                                                 .v0 = -1.0,
                                                 .mu = mu,
                                                 .mu_static = mu,
                                                 .law = RestitutionLaw::kEnergetic,
                                                 .coefficient = 1.0});
    EXPECT_EQ(impact.w_rank, 1);
    EXPECT_EQ(impact.regime, planar.regime) << mu;
    EXPECT_EQ(impact.regime == Regime::kLocked, mu == 3.0);
    EXPECT_NEAR(impact.v1, planar.v1, 1e-14);
    EXPECT_NEAR(impact.u1[0], 0.6 * planar.u1, 1e-14);
    EXPECT_NEAR(impact.tau1, planar.tau1, 1e-14);
    EXPECT_NEAR(impact.poisson, planar.poisson, 1e-14);
  }
}

// A contact in a plane that stands anywhere: Wtt is singular but for rounding, and slip that is 0 but for rounding has
// no direction of its own.
TEST(SpatialTest, AVerticalPlaneThatIsTurnedIsThePlanarModel) {
  SceneSource source(31);
  for (int i = 0; i < 3000; ++i) {
    Problem p = source.Typical();
    p.w12 = p.w22 = p.w23 = 0.0;
    p.u0 = {i % 3 == 0 ? 0.0 : p.u0[0], 0.0};
    const planar::Impact planar = planar::Solve(InPlane(p));
    if (planar.regime == Regime::kWedged) continue;
    const double angle = 0.001 * (i + 1);
    Problem turned = Turned(p, std::cos(angle), std::sin(angle));
    if (i % 3 == 0) turned.u0 = {1e-17 * Scale(p) * (i % 5 - 2), 1e-17 * Scale(p) * (i % 7 - 3)};
    const Impact impact = Solve(turned);
    const double u1 = std::cos(angle) * impact.u1[0] - std::sin(angle) * impact.u1[1];
    const double across = std::sin(angle) * impact.u1[0] + std::cos(angle) * impact.u1[1];
    ASSERT_NEAR(u1, planar.u1, 1e-12 * Scale(p)) << i;
    ASSERT_NEAR(across, 0.0, 1e-12 * Scale(p)) << i;
    ASSERT_NEAR(impact.v1, planar.v1, 1e-12 * Scale(p)) << i;
    ASSERT_LE(impact.error_estimate, 1e-11) << i;
  }
}

TEST(SpatialTest, RankTwoThatSticksIsLocked) {
  // Because wtn = Wtt (1/2, 1/2) and Wnn matches, u and v vanish together once slip has stopped.
  const Problem problem = Contact({1.0, 0.0, 0.5, 1.0, 0.5, 0.5}, {-1.0, -1.0}, -1.0, 1.0, {.coefficient = 0.9});
  const Impact impact = Solve(problem);
  EXPECT_EQ(impact.w_rank, 2);
  EXPECT_EQ(impact.regime, Regime::kLocked);
  EXPECT_EQ(impact.v1, 0.0);
  EXPECT_EQ(impact.tau1, impact.tau_compression);
  EXPECT_EQ(impact.energetic, 0.0);
}

// A point of an arm with two coordinates: M = (4, 2; 2, 5), t1 = (1, 1), t2 = (1, 2), n = (-1, 2), rates (-1, -2).
// Wtt^-1 wtn has the length 5, so that a friction of 5 needs all of its cone to hold the contact.
Problem ArmWithTwoCoordinates(double mu) {
  return Contact({5.0 / 16.0, 7.0 / 16.0, 1.0 / 16.0, 13.0 / 16.0, 11.0 / 16.0, 29.0 / 16.0}, {-3.0, -5.0}, -3.0, mu);
}

TEST(SpatialTest, AContactThatLocksInRestitutionHasTheCoefficientsThatCameOfIt) {
  for (const RestitutionLaw law : {RestitutionLaw::kNewton, RestitutionLaw::kPoisson, RestitutionLaw::kEnergetic}) {
    Problem problem = ArmWithTwoCoordinates(6.0);
    problem.law = law;
    problem.coefficient = law == RestitutionLaw::kNewton ? 0.9 : 50.0;
    const Impact impact = Solve(problem);
    ASSERT_TRUE(impact.Converged());
    EXPECT_EQ(impact.regime, Regime::kStickInRestitution);
    EXPECT_EQ(impact.v1, 0.0);
    EXPECT_EQ(impact.newton, 0.0);
    EXPECT_EQ(impact.poisson, (impact.tau1 - impact.tau_compression) / impact.tau_compression);
    EXPECT_LT(impact.poisson, 49.0);
    EXPECT_GT(impact.tau1, 1.5 * impact.tau_compression);
    // W p = -(u0, v0): the impulse brings the contact to rest.
    const double f1 = impact.f1[0], f2 = impact.f1[1], tau = impact.tau1;
    EXPECT_NEAR((5.0 * f1 + 7.0 * f2 + tau) / 16.0, 3.0, 1e-10);
    EXPECT_NEAR((7.0 * f1 + 13.0 * f2 + 11.0 * tau) / 16.0, 5.0, 1e-10);
    EXPECT_NEAR((f1 + 11.0 * f2 + 29.0 * tau) / 16.0, 3.0, 1e-10);
  }
}

// Slip stands still on the edge of the cone, and v with it: an impact that asks for a larger v has no end.
TEST(SpatialTest, AContactThatOnlyAllOfFrictionHoldsStandsStill) {
  Problem problem = ArmWithTwoCoordinates(5.0);
  problem.law = RestitutionLaw::kNewton;
  problem.coefficient = 1.0;
  double v1 = 0.0;
  for (const double tolerance : {1e-12, 1e-9, 1e-6, 1e-3}) {
    problem.tolerance = tolerance;
    const Impact impact = Solve(problem);
    EXPECT_EQ(impact.termination, Termination::kRefused) << tolerance;
    if (v1 == 0.0) v1 = impact.v1;
    EXPECT_NEAR(impact.v1, v1, tolerance * 5.0);
    EXPECT_GT(impact.v1, 1.0);
  }
  // Its work of restitution grows without end, so that the energetic coefficient is reached there.
  problem.law = RestitutionLaw::kEnergetic;
  problem.coefficient = 0.9;
  EXPECT_TRUE(Solve(problem).Converged());
}

// Compression ends when slip is below rounding already, so that it is in doubt which comes first; but either way the
// contact is locked, or starts from rest.
TEST(SpatialTest, HasAnErrorWhereCompressionEndsNearlyAtRest) {
  const Problem locks = Contact({0x1.aa6d845335bdep-2, -0x1.76a61a4e8cdd6p-4, -0x1.1bf89b498293dp-3,
                                 0x1.58c01c6628fa2p-1, 0x1.44734d407528p-7, 0x1.7f81f6d89d2e5p-5},
                                {0x1.1a8a10f4b4978p-1, -0x1.46faaa9fe864ep-3}, -0x1.75d33fc3b3b89p-3,
                                0x1.820b8a6268ba1p-1, {.coefficient = 0x1.87f9536ed0205p-1});
  const Problem restarts = Contact({0x1.ca1795b4c7dd9p-1, -0x1.3442e2586a706p-2, -0x1.147a1f255d788p-4,
                                    0x1.999b50d878952p-2, 0x1.8e6920476e5fap-3, 0x1.a9b0013f4a723p-4},
                                   {0x1.10e880c709ab3p-1, -0x1.7337ec9da6e95p-1}, -0x1.6a991f3068418p-2,
                                   0x1.0caccfb17d37p-1, {.coefficient = 0x1.52321592a568cp-1});
  for (Problem problem : {locks, restarts}) {
    problem.tolerance = 1e-9;
    for (const RestitutionLaw law : {RestitutionLaw::kNewton, RestitutionLaw::kPoisson, RestitutionLaw::kEnergetic}) {
      problem.law = law;
      const Impact impact = Solve(problem);
      const Impact reference = HWY_NAMESPACE::Solver<long double>(problem, 2, 1e-16L).Run();
      EXPECT_LE(impact.error_estimate, problem.tolerance);
      EXPECT_GE(impact.error_estimate, VelocityError(problem, impact, reference));
      if (problem.mu == locks.mu) {
        EXPECT_EQ(impact.v1, 0.0);
      } else {
        EXPECT_GT(impact.v1, 0.01);
      }
    }
  }
}

// With W = g g^T, g = (0, 2, 1), v' = 1 - 2 mu cos(phi), which hardly rises where slip is almost along t2 and mu is
// 1/2. The normal impulse that leads to a v follows by quadrature.
TEST(SpatialTest, ErrorsHoldWhereVHardlyRises) {
  constexpr double kSingular = 2e-6;  // The rounding of slip counts by the root of that of a singular Wtt.
  const double v0 = -1.5;
  const double u2 = 0.05;
  for (const double mu : {0.45, 0.4995, 0.5}) {
    for (const double u1 : {1.6e-3, 0.03, 0.4}) {
      const auto rise = [mu, u1, u2, v0](long double v) {
        const long double along = u2 + 2.0L * (v - v0);
        const long double slip = std::sqrt(along * along + static_cast<long double>(u1) * u1);
        return (1.0L - 2.0L * mu) + 2.0L * mu * u1 * u1 / (slip * (slip + along));
      };
      const auto impulse_to = [&rise, v0](long double v) {
        constexpr int kPieces = 40000;
        const long double step = (v - v0) / kPieces;
        long double sum = 1.0L / rise(v0) - 1.0L / rise(v);
        for (int i = 0; i < kPieces; ++i) {
          sum += 4.0L / rise(v0 + (i + 0.5L) * step) + 2.0L / rise(v0 + (i + 1.0L) * step);
        }
        return sum * step / 6.0L;
      };
      const long double compression = impulse_to(0.0L);
      for (const double tolerance : {1e-1, 1e-2, 1e-4, 1e-7}) {
        const Problem problem = Contact({0.0, 0.0, 0.0, 4.0, 2.0, 1.0}, {u1, u2}, v0, mu,
                                        {.law = RestitutionLaw::kPoisson, .coefficient = 1.0, .tolerance = tolerance});
        const Impact impact = Solve(problem);
        const std::string where = absl::StrCat("mu ", mu, ", u1 ", u1, ", tolerance ", tolerance);
        const auto found = static_cast<long double>(impact.v1);
        const long double v_error = (impulse_to(found) - 2.0L * compression) * rise(found);
        EXPECT_LE(std::fabs(v_error), 1.1 * impact.errors.v) << where;
        EXPECT_LE(std::fabs(v_error), impact.error_estimate * std::fabs(v0)) << where;
        EXPECT_LE(impact.error_estimate, std::max(tolerance, kSingular)) << where;
        EXPECT_LE(std::fabs(impact.tau_compression - compression), impact.errors.tau_compression) << where;
        EXPECT_LE(std::fabs(impact.tau1 - 2.0L * compression), impact.errors.tau) << where;
        EXPECT_LE(impact.errors.tau, 10.0 * impact.error_estimate * impact.tau1 / rise(found)) << where;
      }
    }
  }
}

// A plastic impact that sticks loses all of q^T W^-1 q/2, q = (u, v). With W = L L^T it is |L^-1 q|^2/2.
TEST(SpatialTest, TheErrorOfTheEnergyHoldsWhereAnIllConditionedContactComesToRest) {
  int stuck = 0;
  for (int i = 0; i < 800; ++i) {
    const auto entry = [i](int k) { return ((i * 37 + k * 101 + i * i * 13) % 61 - 30) / 16.0; };
    const double l11 = 1.0 + i % 5;
    const double l22 = std::ldexp(1.0, -(i % 12));
    const double l33 = std::ldexp(1.0, -(i % 9));
    const double l21 = entry(1);
    const double l31 = entry(2);
    const double l32 = entry(3);
    const Problem problem = Contact({l11 * l11, l11 * l21, l11 * l31, l21 * l21 + l22 * l22, l21 * l31 + l22 * l32,
                                     l31 * l31 + l32 * l32 + l33 * l33},
                                    {entry(4), entry(5)}, -0.25 - std::fabs(entry(6)), 3.0,
                                    {.law = RestitutionLaw::kNewton, .coefficient = 0.0});
    const Impact impact = Solve(problem);
    if (impact.regime != Regime::kStickInCompression) continue;
    ++stuck;
    const long double y1 = problem.u0[0] / l11;
    const long double y2 = (problem.u0[1] - l21 * y1) / l22;
    const long double y3 = (problem.v0 - l31 * y1 - l32 * y2) / l33;
    const long double lost = (y1 * y1 + y2 * y2 + y3 * y3) / 2.0L;
    EXPECT_LE(std::fabs(impact.energy_change + lost), impact.errors.energy_change) << i;
    EXPECT_LE(impact.errors.energy_change, 1e-3L * lost) << i;
  }
  EXPECT_GE(stuck, 40);
}

TEST(SpatialTest, ASingularTangentMatrixSticksByTheSmallestForce) {
  // Nothing moves along t2, so that the contact sticks as in the plane of t1 and n.
  const Problem problem = Contact({1.0, 0.0, 0.5, 0.0, 0.0, 1.0}, {0.2, 0.0}, -1.0, 0.8,
                                  {.law = RestitutionLaw::kPoisson, .coefficient = 0.5});
  const Impact impact = Solve(problem);
  EXPECT_EQ(impact.regime, Regime::kStickInCompression);
  EXPECT_EQ(impact.w_rank, 2);
  EXPECT_EQ(impact.f1[1], 0.0);
  EXPECT_NEAR(impact.f1[0], -0.2 - 0.5 * impact.tau1, 1e-15);
}

TEST(SpatialTest, NewtonsLawMayCreateEnergyAndSaysSo) {
  SceneSource source(26);
  int created = 0;
  for (int i = 0; i < 2000; ++i) {
    Problem problem = source.Typical();
    problem.law = RestitutionLaw::kNewton;
    problem.coefficient = 1.0;
    const Impact impact = Solve(problem);
    if (std::fabs(impact.energy_change) > 1e-6) {
      ASSERT_EQ(impact.energy_limit_broken, impact.energy_change > 0.0) << i;
    }
    if (std::fabs(impact.energetic_excess) > 1e-6) {
      ASSERT_EQ(impact.sharp_limit_broken, impact.energetic_excess > 0.0) << i;
    }
    created += impact.energy_limit_broken ? 1 : 0;
  }
  EXPECT_GT(created, 0);
}

TEST(SpatialTest, ABudgetThatRunsOutIsSaidSo) {
  // Hardly any impact of a valid problem exhausts the budget. One whose numbers are NaN does, and has to return.
  Problem problem = Known(1.0, 0.6, 0.2);
  problem.w12 = std::numeric_limits<double>::quiet_NaN();
  const Impact impact = Solve(problem);
  EXPECT_EQ(impact.termination, Termination::kBudgetUsedUp);
  EXPECT_EQ(impact.regime, Regime::kWedged);
  EXPECT_EQ(impact.error_estimate, std::numeric_limits<double>::infinity());
}

TEST(SpatialTest, AnErrorThatIsNoNumberIsUnknown) {
  // Friction lifts the body at once: its normal impulse is below the least double, and bounds of it exceed the largest.
  const Problem problem = Contact({2.0, 0.3, 0.6, 3.00000000745058, -0.9, 2.5}, {-1.0, 0.6}, -7e-138, 1e300,
                                  {.law = RestitutionLaw::kNewton, .coefficient = 0.5, .tolerance = 0.01});
  EXPECT_EQ(Solve(problem).error_estimate, std::numeric_limits<double>::infinity());
}

// One free coordinate in the plane of t1 and n, beside a coordinate that is held and moves. With f = -0.1 tau, u grows
// by 0.4 tau and v by 0.2 tau, so that v vanishes at tau = 5, where u has grown by 2.
TEST(SpatialTest, ACoordinateInAPlaneBesideOneThatIsHeldKeepsNoSlipBeside) {
  Problem problem =
      Contact({1.0, 0.0, 0.5, 0.0, 0.0, 0.25}, {}, -1.0, 0.1, {.law = RestitutionLaw::kEnergetic, .tolerance = 1e-10});
  const Impact from_rest = Solve(problem);
  EXPECT_NEAR(from_rest.u1[0], 2.0, from_rest.errors.u);
  EXPECT_LT(from_rest.errors.u, 1e-14);
  problem.u0 = {-0.3, 0.0};
  // u vanishes at tau = 0.3/0.6, where v is 0.3*0.5 - 1; from there v needs 0.85/0.2, in which u grows by 0.4 of that.
  const Impact reversal = Solve(problem);
  EXPECT_NEAR(reversal.u1[0], 1.7, reversal.errors.u);
  EXPECT_LT(reversal.errors.u, 1e-14);
}

}  // namespace
}  // namespace ricochet::spatial
