// Differences against exact derivatives of planar impacts, against arbitrary precision in space and for compliance, and
// against formulas for impacts that take time.

#include "core/answer/differences.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "core/answer/derivative_paths.h"
#include "core/answer/derivatives.h"
#include "core/answer/exact_derivatives.h"
#include "core/contact/scene_contact.h"
#include "core/models/spatial/spatial.h"
#include "core/plan/scene_problem.h"
#include "core/scene/numbers.h"
#include "core/scene/validate.h"
#include "ricochet/solver.h"
#include "tests/support/oracles/compliant_oracle.h"
#include "tests/support/oracles/spatial_oracle.h"
#include "tests/support/scenes/random_scenes.h"

namespace ricochet {
namespace {

constexpr char kMu[] = "friction.kinetic_coefficient";
constexpr char kTau[] = "impulse.normal_total_n_s";

bool Never() { return false; }

std::vector<Derivative> Differences(const Scene& scene, const DerivativePaths& paths) {
  const auto source = OutcomeSamples(scene, {}, paths.of, Never);
  EXPECT_TRUE(source.ok()) << source.status();
  if (!source.ok()) return {};
  absl::StatusOr<std::vector<Derivative>> derivatives = DifferencesOf(**source, scene, paths);
  EXPECT_TRUE(derivatives.ok()) << derivatives.status();
  return derivatives.ok() ? *derivatives : std::vector<Derivative>();
}

Derivative Only(const Scene& scene, const std::string& of, const std::string& by) {
  return Differences(scene, {.of = {of}, .by = {by}}).front();
}

// --- Impacts that have exact derivatives, too ---

class PlanarSystem : public testing::TestWithParam<size_t> {};

TEST_P(PlanarSystem, HasTheExactDerivatives) {
  const RandomSystem system = RandomSystems()[GetParam()];
  RandomScenes random(40 + GetParam());
  int compared = 0, missed = 0;
  for (const SceneKind& kind : SceneKinds(system)) {
    for (int i = 0; i < 60; ++i) {
      const Scene scene = kind.make(random);
      if (!Validate(scene).empty() || WhyNotExact(scene) != nullptr) continue;
      const DerivativePaths all = AllDerivativePaths(scene);
      const std::string& by = all.by[static_cast<size_t>(i) % all.by.size()];
      if (!NumberAt(scene, by).has_value()) continue;
      const std::vector<Derivative> exact = ExactDerivativesOf(scene, {.of = all.of, .by = {by}});
      const std::vector<Derivative> found = Differences(scene, {.of = all.of, .by = {by}});
      for (size_t k = 0; k < exact.size(); ++k) {
        if (!exact[k].value.has_value()) continue;
        ++compared;
        if (!found[k].value.has_value()) {
          ++missed;
          continue;
        }
        const double error = std::fabs(*found[k].value - *exact[k].value);
        ASSERT_LE(error, 4.0 * *found[k].error + 1e-10 * std::max(std::fabs(*exact[k].value), 1e-4))
            << kind.name << " " << exact[k].of << " by " << by << ": " << *found[k].value << ", exact "
            << *exact[k].value;
      }
    }
  }
  EXPECT_GE(compared, 1'000);
  EXPECT_LE(missed, compared / 100);
}

INSTANTIATE_TEST_SUITE_P(Systems, PlanarSystem, testing::Range<size_t>(0, 6));

// --- In space ---

using Exact = std::vector<Ball>;

Exact NumbersOf(const spatial::ExactImpact& impact) {
  return {impact.u1[0], impact.u1[1], impact.v1, impact.f1[0], impact.f1[1], impact.tau1, impact.energy_change};
}

const std::vector<std::string> kInSpace = {"contact_velocity_after.tangential_m_s[0]",
                                           "contact_velocity_after.tangential_m_s[1]",
                                           "contact_velocity_after.normal_m_s",
                                           "impulse.tangential_n_s[0]",
                                           "impulse.tangential_n_s[1]",
                                           kTau,
                                           "energy_change_j"};

// The numbers with one of the nine numbers of the contact moved.
std::optional<Exact> Moved(const spatial::Problem& p, size_t number, double step) {
  spatial::ExactContact contact = {.w = {Ball(p.w11), Ball(p.w12), Ball(p.w13), Ball(p.w22), Ball(p.w23), Ball(p.w33)},
                                   .u0 = {Ball(p.u0[0]), Ball(p.u0[1])},
                                   .v0 = Ball(p.v0)};
  Ball& moved = number < 6 ? contact.w[number] : number < 8 ? contact.u0[number - 6] : contact.v0;
  moved = moved + Ball(step);
  const auto impact = spatial::SolveExactly(p, contact);
  if (!impact.has_value()) return std::nullopt;
  return NumbersOf(*impact);
}

// Central differences with steps h and 2 h, extrapolated.
std::optional<Exact> SpatialQuotients(const spatial::Problem& p, size_t number, double h) {
  std::vector<Exact> at;
  for (const double steps : {-2.0, -1.0, 1.0, 2.0}) {
    const std::optional<Exact> numbers = Moved(p, number, steps * h);
    if (!numbers.has_value()) return std::nullopt;
    at.push_back(*numbers);
  }
  Exact quotients;
  for (size_t i = 0; i < kInSpace.size(); ++i) {
    quotients.push_back((Ball(8.0) * (at[2][i] - at[1][i]) - (at[3][i] - at[0][i])) / Ball(12.0 * h));
  }
  return quotients;
}

TEST(DifferencesTest, ImpactInSpaceHasTheQuotientsOfArbitraryPrecision) {
  RandomScenes random(61);
  const RandomSystem system = RandomSystems()[9];
  ASSERT_EQ(system.name, "spatial_contact");
  int compared = 0, above_limit = 0;
  for (int i = 0; i < 200; ++i) {
    const Scene scene = SceneKinds(system)[static_cast<size_t>(i) % 3].make(random);
    if (!Validate(scene).empty()) continue;
    const SceneContact contact(scene);
    const spatial::Problem problem = spatial::MakeProblem(std::get<SpatialReduction>(contact.reduction),
                                                          scene.restitution, contact.coefficients, 1e-14);
    if (problem.v0 >= 0.0 || !(problem.mu > 0.0)) continue;
    const size_t number = static_cast<size_t>(i) % 9;
    // The oracle is right to about 1e-18, and how far two steps differ tells what the quotients are right to.
    const std::optional<Exact> exact = SpatialQuotients(problem, number, 0x1p-16);
    const std::optional<Exact> other = SpatialQuotients(problem, number, 0x1p-14);
    if (!exact.has_value() || !other.has_value()) continue;
    const std::string by = number < 6   ? "spatial_contact.w_per_kg[" + std::to_string(number) + "]"
                           : number < 8 ? "spatial_contact.tangential_m_s[" + std::to_string(number - 6) + "]"
                                        : "spatial_contact.normal_m_s";
    const std::vector<Derivative> found = Differences(scene, {.of = kInSpace, .by = {by}});
    double typical = 1e-3, known_to = 1e-18 / 0x1p-16;
    for (size_t k = 0; k < exact->size(); ++k) {
      typical = std::max(typical, std::fabs((*exact)[k].Nearest()));
      known_to = std::max(known_to, std::fabs(((*exact)[k] - (*other)[k]).Nearest()));
    }
    for (size_t k = 0; k < found.size(); ++k) {
      ASSERT_TRUE(found[k].value.has_value()) << by << " " << found[k].reason << "\n" << spatial::ToString(problem);
      const double error = std::fabs((Ball(*found[k].value) - (*exact)[k]).Nearest());
      EXPECT_LE(error, *found[k].error + 2.0 * known_to) << found[k].of << " by " << by << "\n"
                                                         << spatial::ToString(problem);
      above_limit += error > 1e-10 * typical ? 1 : 0;
      ++compared;
    }
  }
  EXPECT_GE(compared, 250);
  EXPECT_LE(above_limit, compared / 1'000);
}

// The slip comes so near to rest that it turns within 1e-5 m/s: steps that are longer see another slope, and do not
// notice.
TEST(DifferencesTest, ASharpBendIsNotSteppedOver) {
  const std::vector<SpatialContact> bends = {{{2.8397715568635444, 0.7229502910020312, -3.5850057427961612,
                                               3.3150037349653902, 2.6649145049245866, 8.862309425664963},
                                              {0.3237333775692052, -0.24142295334220468},
                                              -1.0},
                                             {{3.6307793980178076, -2.1797399386477827, -1.7834344257004713,
                                               2.781738252104455, 2.5462231715782857, 3.537138546464522},
                                              {0.0705692014444155, -0.08351118865705844},
                                              -1.0}};
  const std::vector<double> frictions = {0.3299276218004305, 0.35895935280954266};
  for (size_t i = 0; i < bends.size(); ++i) {
    const Scene scene = {
        .system = bends[i], .friction = {.kinetic_coefficient = frictions[i]}, .restitution = PoissonCoefficient{0.7}};
    const SceneContact contact(scene);
    const spatial::Problem problem = spatial::MakeProblem(std::get<SpatialReduction>(contact.reduction),
                                                          scene.restitution, contact.coefficients, 1e-14);
    const Exact exact = SpatialQuotients(problem, 6, 0x1p-26).value();
    const Exact other = SpatialQuotients(problem, 6, 0x1p-25).value();
    const std::vector<Derivative> found =
        Differences(scene, {.of = kInSpace, .by = {"spatial_contact.tangential_m_s[0]"}});
    for (size_t k = 0; k < found.size(); ++k) {
      const double known_to = std::fabs((exact[k] - other[k]).Nearest()) + 1e-10;
      ASSERT_TRUE(found[k].value.has_value()) << found[k].of;
      EXPECT_NEAR(*found[k].value, exact[k].Nearest(), *found[k].error + known_to) << found[k].of;
    }
  }
}

Scene BallOnCushion() {
  return {.system = SpatialContact{{3.5, 0.0, 0.0, 3.5, 0.0, 1.0}, {0.0, 0.4}, -1.0},
          .friction = {.kinetic_coefficient = 0.2},
          .restitution = EnergeticCoefficient{0.8}};
}

TEST(DifferencesTest, SphereThatSlidesIsItsFormula) {
  // Slip keeps its direction, u2' = u2 - mu W11 tau with tau = (1 + e) |v0| / W33.
  const Scene scene = [] {
    Scene sliding = BallOnCushion();
    std::get<SpatialContact>(sliding.system).tangential_m_s = {0.0, 4.0};
    return sliding;
  }();
  const Derivative by_mu = Only(scene, "contact_velocity_after.tangential_m_s[1]", kMu);
  EXPECT_NEAR(*by_mu.value, -3.5 * 1.8, 1e-11);
  const Derivative by_e = Only(scene, "contact_velocity_after.tangential_m_s[1]", "restitution.energetic");
  EXPECT_NEAR(*by_e.value, -3.5 * 0.2, 1e-11);
  // A number of the scene that is 0: slip turns with it.
  const Derivative across = Only(scene, "impulse.tangential_n_s[0]", "spatial_contact.tangential_m_s[0]");
  EXPECT_NEAR(*across.value, -0.2 * 1.8 / 4.0, 1e-11);
}

// The scale of a velocity that is 0 is that of the terms that make it.
TEST(DifferencesTest, VelocityThatIsZeroDoesNotJump) {
  // A sphere that slides along x: v_y' = v_y - mu (1 + e) |v_z| v_y/|v|. Nothing turns it about z.
  const Scene sphere = {.system = SpatialBody{.mass_kg = 2.0,
                                              .inertia_com_kg_m2 = {0.2, 0.0, 0.0, 0.2, 0.0, 0.2},
                                              .offset_m = {0.0, 0.0, -0.5},
                                              .linear_m_s = {4.0, 0.0, -2.0},
                                              .angular_rad_s = {0.0, 0.0, 0.0}},
                        .friction = {.kinetic_coefficient = 0.1},
                        .restitution = EnergeticCoefficient{0.5}};
  const Derivative across = Only(sphere, "bodies_after[0].linear_m_s[1]", "spatial_body.linear_m_s[1]");
  EXPECT_EQ(across.kind, DerivativeKind::kTwoSided);
  EXPECT_NEAR(*across.value, 1.0 - 0.1 * 1.5 * 2.0 / 4.0, 1e-11);
  const Derivative spin = Only(sphere, "bodies_after[0].angular_rad_s[2]", "spatial_body.angular_rad_s[2]");
  EXPECT_EQ(spin.kind, DerivativeKind::kTwoSided);
  EXPECT_NEAR(*spin.value, 1.0, 1e-11);
  // tau = (1 + e) |v0|/W33 below v0 = 0, and nothing strikes above.
  Scene grazing = BallOnCushion();
  std::get<SpatialContact>(grazing.system).normal_m_s = 0.0;
  const Derivative impulse = Only(grazing, kTau, "spatial_contact.normal_m_s");
  EXPECT_EQ(impulse.threshold, Threshold::kApproach);
  EXPECT_NEAR(*impulse.from_below, -1.8, 1e-11);
  EXPECT_EQ(impulse.from_above, 0.0);
}

// A coordinate at rest that the impact does not touch: nothing changes it.
TEST(DifferencesTest, VelocityThatStaysAtRestHasTheDerivativeZero) {
  const Scene arm = {.system = Mechanism{.mass_matrix = {1, 0, 0, 0, 1, 0, 0, 0, 1},
                                         .jacobian = {1, 0, 0, 0, 0, 0, 0, 1, 0},
                                         .rates = {1.0, -1.0, 0.0}},
                     .friction = {.kinetic_coefficient = 0.3},
                     .restitution = NewtonCoefficient{0.5}};
  for (const char* by : {"mechanism.rates[0]", "mechanism.rates[1]", kMu}) {
    const Derivative d = Only(arm, "rates_after[2]", by);
    EXPECT_EQ(d.kind, DerivativeKind::kTwoSided) << by << d.reason;
    EXPECT_EQ(d.value, 0.0) << by;
  }
}

// The works that add up to a total err by more than its other digits: the spheres slip straight on here, and turn
// beside. By symmetry the derivative is 0.
TEST(DifferencesTest, TotalOfWorksHasTheErrorsOfItsParts) {
  const auto sphere = [](double n, std::vector<double> velocity) {
    return SpatialBody{.mass_kg = 1.0,
                       .inertia_com_kg_m2 = {0.4, 0.0, 0.0, 0.4, 0.0, 0.4},
                       .offset_m = {0.0, 0.0, n},
                       .linear_m_s = {velocity[0], velocity[1], velocity[2]},
                       .angular_rad_s = {0.0, 0.0, 0.0}};
  };
  const Scene scene = {.system = BodyPair{.bodies = SpatialPair{.body_1 = sphere(-0.1, {0.3, 0.0, -1.0}),
                                                                .body_2 = sphere(0.1, {0.0, 0.0, 0.0})}},
                       .friction = {.kinetic_coefficient = 0.2},
                       .restitution = NewtonCoefficient{0.5}};
  for (const char* of : {"work.normal_total_j", "work.tangential_total_j", "work.friction_dissipation_j"}) {
    const Derivative d = Only(scene, of, "body_pair.spatial.body_1.offset_m[1]");
    EXPECT_EQ(d.kind, DerivativeKind::kTwoSided) << of << d.reason;
    EXPECT_LE(std::fabs(d.value.value_or(1.0)), d.error.value_or(0.0)) << of;
    EXPECT_LE(d.error.value_or(1.0), 1e-6) << of;
  }
}

TEST(DifferencesTest, RateOfAPlasticPendulumOnATangentialSpringFollowsItsContact) {
  const Scene scene = {.system = Pendulum{.inertia_kg_m2 = 1.0, .a_m = 0.5, .b_m = 0.3, .omega_minus_rad_s = -1.0},
                       .friction = {.kinetic_coefficient = 0.1},
                       .restitution = EnergeticCoefficient{0.0},
                       .compliance = Compliance{.tangential_ratio_squared = 1.2}};
  const Derivative normal = Only(scene, "contact_velocity_after.normal_m_s", "restitution.energetic");
  const Derivative rate = Only(scene, "rates_after_rad_s[0]", "restitution.energetic");
  ASSERT_TRUE(normal.from_above.has_value() && rate.from_above.has_value()) << normal.reason << rate.reason;
  EXPECT_NEAR(std::fabs(*rate.from_above) * 0.5, std::fabs(*normal.from_above), 1e-9);
}

TEST(DifferencesTest, SphereThatSticksDoesNotFeelFriction) {
  const Derivative by_mu = Only(BallOnCushion(), "contact_velocity_after.tangential_m_s[1]", kMu);
  EXPECT_EQ(by_mu.kind, DerivativeKind::kTwoSided);
  EXPECT_EQ(by_mu.value, 0.0);
}

TEST(DifferencesTest, SlipThatStopsJustAtTheEndHasTwoSides) {
  Scene scene = BallOnCushion();
  // mu W11 tau = 0.5 * 4 * 1.5 = 3 = u2.
  scene.system = SpatialContact{{4.0, 0.0, 0.0, 4.0, 0.0, 1.0}, {0.0, 3.0}, -1.0};
  scene.friction.kinetic_coefficient = 0.5;
  scene.restitution = NewtonCoefficient{0.5};
  const Derivative d = Only(scene, "contact_velocity_after.tangential_m_s[1]", kMu);
  EXPECT_EQ(d.kind, DerivativeKind::kOneSided);
  EXPECT_EQ(d.threshold, Threshold::kImpactEnd);
  EXPECT_NEAR(*d.from_below, -6.0, 1e-9);
  EXPECT_NEAR(*d.from_above, 0.0, 1e-9);
}

// By Newton's law slip stops at the end where u0 = (mu Wtt - Wtn) tau, tau = (1 + e)|v0| / Wnn.
TEST(DifferencesTest, AThresholdNearbyHidesNoDerivative) {
  int found_two_sided = 0;
  for (int power = 20; power < 43; ++power) {
    const double distance = std::ldexp(1.0, -power);
    for (const double sign : {-1.0, 1.0}) {
      const Scene scene = {.system = PlanarContact{2.0, 0.5, 1.0, 0.75 * (1.0 + sign * distance), -1.0},
                           .friction = {.kinetic_coefficient = 0.5},
                           .restitution = NewtonCoefficient{0.5}};
      const DerivativePaths paths = {.of = AllDerivativePaths(scene).of,
                                     .by = {kMu, "planar_contact.tangential_m_s", "restitution.newton"}};
      const std::vector<Derivative> exact = ExactDerivativesOf(scene, paths);
      const std::vector<Derivative> found = Differences(scene, paths);
      for (size_t k = 0; k < exact.size(); ++k) {
        if (exact[k].kind != DerivativeKind::kTwoSided) continue;
        ASSERT_EQ(found[k].kind, DerivativeKind::kTwoSided)
            << exact[k].of << " by " << exact[k].by << ", " << sign * distance << ": " << found[k].reason;
        EXPECT_NEAR(*found[k].value, *exact[k].value, *found[k].error + 1e-12) << exact[k].of << " by " << exact[k].by;
        ++found_two_sided;
      }
    }
  }
  EXPECT_GT(found_two_sided, 1'000);
}

// Slip in space stops at the end where |u0| = mu W11 tau. Energy that friction takes is smooth on either side.
TEST(DifferencesTest, AThresholdNearbyInSpaceHidesNoDerivative) {
  for (int k = 16; k <= 40; ++k) {
    for (const double sign : {-1.0, 1.0}) {
      const double slip = 1.5 * (1.0 + sign * std::ldexp(1.0, -k));
      const Scene scene = {.system = SpatialContact{{2.0, 0.0, 0.0, 2.0, 0.0, 1.0}, {0.6 * slip, 0.8 * slip}, -1.0},
                           .friction = {.kinetic_coefficient = 0.5},
                           .restitution = NewtonCoefficient{0.5}};
      const Derivative found = Only(scene, "energy_change_j", kMu);
      EXPECT_EQ(found.kind, DerivativeKind::kTwoSided) << sign * k << ": " << found.reason;
      // While it slips, friction takes mu tau |u0| - W11 (mu tau)^2 / 2, and tau = 1.5; later it has taken all.
      const double slope = sign > 0.0 ? -1.5 * slip + 2.0 * 0.5 * 1.5 * 1.5 : 0.0;
      EXPECT_NEAR(found.value.value_or(1.0), slope, 1e-12 + found.error.value_or(0.0)) << sign * k;
    }
  }
}

// Slip on a tangential spring starts at |u0| = mu ratio^2 |v0|. The velocity has one slope there, which it approaches
// as the root of the distance; quotients of 50 digits, extrapolated, give 0.1661296698 on both sides.
TEST(DifferencesTest, SidesThatDifferByLessThanTheirErrorsAreOne) {
  const Scene scene = {.system = PlanarContact{2.0, 0.5, 1.0, 0.625, -1.0},
                       .friction = {.kinetic_coefficient = 0.5},
                       .restitution = EnergeticCoefficient{0.8},
                       .compliance = Compliance{.tangential_ratio_squared = 1.25}};
  const Derivative found = Only(scene, "contact_velocity_after.normal_m_s", "planar_contact.tangential_m_s");
  EXPECT_EQ(found.kind, DerivativeKind::kTwoSided) << found.reason;
  EXPECT_NEAR(found.value.value_or(0.0), 0.1661296698, found.error.value_or(0.0));
  EXPECT_LT(found.error.value_or(1.0), 1e-3);
}

TEST(DifferencesTest, SlipThatWouldStartIsNamed) {
  Scene scene = BallOnCushion();
  scene.system = SpatialContact{{4.0, 0.0, 2.0, 4.0, 0.0, 4.0}, {0.0, 0.0}, -1.0};
  scene.friction.kinetic_coefficient = 0.25;
  const Derivative d = Only(scene, kTau, "spatial_contact.tangential_m_s[0]");
  EXPECT_EQ(d.threshold, Threshold::kSlipStart);
}

TEST(DifferencesTest, FrictionOfZeroHasOneSide) {
  Scene scene = BallOnCushion();
  scene.friction.kinetic_coefficient = 0.0;
  const Derivative d = Only(scene, "impulse.tangential_n_s[1]", kMu);
  EXPECT_EQ(d.threshold, Threshold::kDomain);
  EXPECT_FALSE(d.from_below.has_value());
  EXPECT_NEAR(*d.from_above, -1.8, 1e-9);
  EXPECT_THAT(d.reason, testing::HasSubstr("break a rule"));
}

TEST(DifferencesTest, ContactThatOnlyJustApproachesJumps) {
  Scene scene = BallOnCushion();
  std::get<SpatialContact>(scene.system).normal_m_s = 0.0;
  const Derivative d = Only(scene, "coefficients.newton", "spatial_contact.normal_m_s");
  EXPECT_EQ(d.threshold, Threshold::kApproach);
  EXPECT_FALSE(d.from_below.has_value());
  EXPECT_THAT(d.reason, testing::HasSubstr("Below, the number jumps"));
}

TEST(DifferencesTest, SpeedOfATableIsAThreshold) {
  Scene scene = BallOnCushion();
  scene.restitution_by_speed = SpeedTable{{0.5, 1.0, 2.0}, {1.0, 0.75, 0.7}};
  const Derivative d = Only(scene, "contact_velocity_after.normal_m_s", "spatial_contact.normal_m_s");
  EXPECT_EQ(d.kind, DerivativeKind::kOneSided);
  EXPECT_EQ(d.threshold, Threshold::kSpeedTable);
  // v' = e(s) s with s = -v, e(1) = 0.6 and slopes of e of -0.04 above s = 1 and -0.4 below.
  EXPECT_NEAR(*d.from_below, -(0.6 - 0.04), 1e-9);
  EXPECT_NEAR(*d.from_above, -(0.6 - 0.4), 1e-9);
}

// --- Compliance ---

TEST(DifferencesTest, TangentialSpringHasTheQuotientsOfArbitraryPrecision) {
  RandomScenes random(62);
  const RandomSystem system = RandomSystems()[4];
  ASSERT_EQ(system.name, "planar_contact");
  int compared = 0, refused = 0;
  for (int i = 0; i < 120; ++i) {
    Scene scene = SceneKinds(system)[0].make(random);
    scene.compliance = Compliance{.tangential_ratio_squared = random.Power(-0.3, 0.5), .normal = {}};
    const double mu = scene.friction.kinetic_coefficient;
    if (!Validate(scene).empty() || mu == 0.0) continue;
    const auto at = [&scene](double friction) {
      Scene moved = scene;
      moved.friction.kinetic_coefficient = friction;
      const SceneContact contact(moved);
      const compliant::Problem problem = {.contact = planar::MakeProblem(std::get<PlanarReduction>(contact.reduction),
                                                                         moved.restitution, contact.coefficients),
                                          .ratio_squared = *scene.compliance->tangential_ratio_squared};
      return compliant::SolveExactly(problem);
    };
    const SceneContact contact(scene);
    if (std::get<PlanarReduction>(contact.reduction).v0 >= 0.0) continue;
    const auto here = at(mu);
    // The quotient of differences of this size on both sides; nothing if they follow another course.
    const auto quotient = [&](double step) -> std::optional<double> {
      const double below = mu * (1.0 - step), above = mu * (1.0 + step);
      const auto low = at(below), high = at(above);
      if (!low.ends || !high.ends || low.regime != high.regime || low.sections.size() != here.sections.size() ||
          high.sections.size() != here.sections.size()) {
        return std::nullopt;
      }
      return ((high.tau1 - low.tau1) / (Ball(above) - Ball(below))).Nearest();
    };
    // The difference of two quotients tells how accurate the one with the smaller step is.
    const std::optional<double> exact = quotient(0x1p-24), other = quotient(0x1p-23);
    if (!exact.has_value() || !other.has_value()) continue;
    const Derivative d = Only(scene, kTau, kMu);
    if (!d.value.has_value()) {
      ++refused;
      continue;
    }
    EXPECT_NEAR(*d.value, *exact, std::max(*d.error, 1e-10) + 2.0 * std::fabs(*exact - *other));
    ++compared;
  }
  EXPECT_GE(compared, 60);
  EXPECT_LE(refused, 3);
}

// --- In time ---

Scene Dropped(const NormalSpring& spring) {
  return {.system = PlanarContact{2.0, 0.0, 4.0, 0.0, -3.0},
          .friction = {.kinetic_coefficient = 0.2},
          .restitution = EnergeticCoefficient{0.5},
          .compliance = Compliance{.tangential_ratio_squared = {}, .normal = spring}};
}

TEST(DifferencesTest, LinearSpringIsItsFormula) {
  constexpr double kPi = 3.14159265358979323846, kStiffness = 1e5;
  const Scene scene = Dropped(LinearSpring{kStiffness});
  // Loading takes a quarter of a period, unloading e times as long: T = (1 + e) pi/2 / sqrt(k W), F = |v| sqrt(k/W).
  const double duration = 1.5 * kPi / 2.0 / std::sqrt(4.0 * kStiffness);
  const double peak = 3.0 * std::sqrt(kStiffness / 4.0);
  const auto by_stiffness = Differences(
      scene, {.of = {"contact.duration_s", "contact.peak_normal_n"}, .by = {"compliance.linear.stiffness_n_m"}});
  EXPECT_NEAR(*by_stiffness[0].value / (-duration / (2.0 * kStiffness)), 1.0, 1e-8);
  EXPECT_NEAR(*by_stiffness[1].value / (peak / (2.0 * kStiffness)), 1.0, 1e-8);
  EXPECT_NEAR(*Only(scene, "contact.duration_s", "restitution.energetic").value / (duration / 1.5), 1.0, 1e-8);
  EXPECT_NEAR(*Only(scene, "contact.peak_normal_n", "planar_contact.normal_m_s").value / (-peak / 3.0), 1.0, 1e-8);
}

TEST(DifferencesTest, HertzSpringHasThePowersOfItsScaling) {
  // The duration of a Hertz contact goes with k^(-2/5) |v|^(-1/5).
  const Scene scene = Dropped(HertzSpring{1e7});
  const LocalSolver solver;
  const auto solved = solver.Solve({.scene = scene, .demand = {.required = {Effect::kFiniteDuration}}});
  ASSERT_TRUE(solved.ok()) << solved.status();
  const double duration = solved->outcome.contact->duration_s;
  const Derivative by_k = Only(scene, "contact.duration_s", "compliance.hertz.stiffness_n_m1_5");
  EXPECT_NEAR(*by_k.value * 1e7 / duration, -0.4, 1e-7);
  const Derivative by_v = Only(scene, "contact.duration_s", "planar_contact.normal_m_s");
  EXPECT_NEAR(*by_v.value * -3.0 / duration, -0.2, 1e-7);
}

// A quotient of two outcomes as wide apart as half their digits allow.
double Quotient(const Scene& scene, const std::string& of, const std::string& by) {
  constexpr double kStep = 1e-6;
  BatchSetup setup = {.scene = scene, .fields = {by}, .columns = {of}};
  const double at = *NumberAt(scene, by);
  const std::vector<double> in = {at - kStep, at + kStep};
  std::vector<double> out(2);
  EXPECT_TRUE(LocalSolver().SolveBatch(setup, {.inputs = {in}, .outputs = {absl::MakeSpan(out)}}).ok());
  return (out[1] - out[0]) / (2.0 * kStep);
}

// The peak of the force moves to another phase of the impact at a ten thousandth of the friction beside the scene.
TEST(DifferencesTest, NoQuotientReachesAcrossAPeakThatMovesNearby) {
  const PlanarBody upper = {.mass_kg = 1.0,
                            .inertia_com_kg_m2 = 0.1,
                            .offset_t_m = 0.1,
                            .offset_n_m = -0.3,
                            .velocity_t_m_s = 1.0,
                            .velocity_n_m_s = -2.0,
                            .rate_rad_s = 0.5};
  const PlanarBody lower = {.mass_kg = 2.0,
                            .inertia_com_kg_m2 = 0.1,
                            .offset_t_m = 0.2,
                            .offset_n_m = 0.3,
                            .velocity_t_m_s = 0.1,
                            .velocity_n_m_s = 0.3,
                            .rate_rad_s = -0.5};
  const Scene scene = {.system = BodyPair{PlanarPair{upper, lower}},
                       .friction = {.kinetic_coefficient = 0.3},
                       .compliance = Compliance{.normal = HuntCrossleySpring{1e6, 1.5, 0.3}}};
  const std::string peak = "contact.peak_normal_n";
  for (const std::string by : {kMu, "body_pair.planar.body_1.mass_kg", "body_pair.planar.body_1.offset_t_m"}) {
    const Derivative derivative = Only(scene, peak, by);
    ASSERT_TRUE(derivative.value.has_value()) << by;
    EXPECT_NEAR(*derivative.value, Quotient(scene, peak, by), 1e-4 * std::fabs(*derivative.value)) << by;
  }
}

// The impulses of such an impact have estimated errors only, from which no error of the rates is proved.
TEST(DifferencesTest, RatesOfAMechanismOnATangentialSpringHaveDerivatives) {
  const Scene scene = {
      .system = Mechanism{.mass_matrix = {2.0, 0.3, 0.3, 1.5}, .jacobian = {1.0, 0.5, 0.2, 0.7}, .rates = {0.4, -1.9}},
      .friction = {.kinetic_coefficient = 0.3},
      .restitution = EnergeticCoefficient{0.7},
      .compliance = Compliance{.tangential_ratio_squared = 1.2}};
  for (const std::string by : {kMu, "restitution.energetic"}) {
    for (const std::string of : {"rates_after[0]", "rates_after[1]"}) {
      const Derivative derivative = Only(scene, of, by);
      ASSERT_TRUE(derivative.value.has_value()) << of << by;
      EXPECT_NEAR(*derivative.value, Quotient(scene, of, by), 1e-7) << of << by;
    }
  }
}

TEST(DifferencesTest, ImpactLawIsItsFormula) {
  Scene scene = Dropped(std::monostate());
  scene.compliance.reset();
  scene.restitution = std::monostate();
  scene.impact_law = WhittakerLaw{0.5};
  // Without coupling Whittaker's law is v' = -e v.
  EXPECT_NEAR(*Only(scene, "contact_velocity_after.normal_m_s", "whittaker.e").value, 3.0, 1e-11);
}

TEST(DifferencesTest, NumberThatIsAskedForTwiceIsAnsweredTwice) {
  const auto found = Differences(BallOnCushion(), {.of = {kTau, kTau}, .by = {"restitution.energetic"}});
  EXPECT_NEAR(*found[0].value, 1.0, 1e-11);  // tau = (1 + e) |v0| / W33
  EXPECT_EQ(found[1].value, found[0].value);
}

TEST(DifferencesTest, ComponentsShareAnError) {
  Scene scene = BallOnCushion();
  std::get<SpatialContact>(scene.system).tangential_m_s = {4.0, 4.0};
  const std::string slip = "contact_velocity_after.tangential_m_s";
  const auto found = Differences(scene, {.of = {slip + "[0]", slip + "[1]"}, .by = {kMu}});
  EXPECT_NEAR(*found[0].value, -3.5 * 1.8 * std::sqrt(0.5), 1e-11);
  EXPECT_NEAR(*found[1].error / *found[0].error, 1.0, 0.5);
}

// Friction that holds is that of sliding where none is stated: it can be more, which this sliding ball does not feel.
TEST(DifferencesTest, StaticFrictionThatIsNotStatedHasItsUpperSide) {
  const Derivative found = Only(BallOnCushion(), kTau, "friction.static_coefficient");
  EXPECT_EQ(found.kind, DerivativeKind::kOneSided);
  EXPECT_FALSE(found.from_below.has_value());
  EXPECT_EQ(found.from_above, 0.0);
}

TEST(DifferencesTest, StopsSoon) {
  int asked = 0;
  const auto stopped = [&asked] { return ++asked > 10; };
  const auto derivatives = DerivativesOf(BallOnCushion(), {}, {.of = {kTau}, .by = {kMu}}, stopped);
  EXPECT_TRUE(absl::IsCancelled(derivatives.status()));
  EXPECT_LE(asked, 11);
}

}  // namespace
}  // namespace ricochet
