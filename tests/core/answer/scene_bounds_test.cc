// Bounds of every system.

#include "core/answer/scene_bounds.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "ricochet/error.h"
#include "ricochet/solver.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet {
namespace {

using testing::ElementsAre;

// The rod at 45 degrees.
Scene Rod() {
  Scene scene = With(PlanarContact{2.5, 1.5, 2.5, -1.0, -1.0});
  scene.friction.kinetic_coefficient = 0.7;
  return scene;
}

Scene SomePendulum() { return With(Pendulum{1.0, 3.0, 1.0, -1.0}); }

BoundsResponse Ask(const Scene& scene) {
  const auto response = LocalSolver().Bounds({.scene = scene});
  EXPECT_TRUE(response.ok()) << response.status();
  return response.value_or(BoundsResponse());
}

std::vector<Violation> Refused(const Scene& scene) {
  return ViolationsOf(LocalSolver().Bounds({.scene = scene}).status());
}

Coefficients SolveAt(Scene scene, double energetic) {
  scene.restitution = EnergeticCoefficient{energetic};
  const auto response = LocalSolver().Solve({.scene = scene});
  EXPECT_TRUE(response.ok()) << response.status();
  return response.ok() ? response->outcome.coefficients : Coefficients();
}

void ExpectWithin(double value, const Range& range, double slack) {
  EXPECT_GE(value, range.lower - slack);
  EXPECT_LE(value, range.upper + slack);
}

bool IsInSpace(const System& system) { return TangentialDirections(system) == 2; }

// ---- Every system ----

TEST(SceneBoundsTest, AsksBeforeEachImpactOfASampleWhetherToStop) {
  for (const System& system : Systems()) {
    int looks = 0;
    const auto count = [&looks] {
      ++looks;
      return false;
    };
    ASSERT_TRUE(SolveSceneBounds(With(system), std::nullopt, count).ok());
    EXPECT_EQ(looks, IsInSpace(system) ? kSpatialImpacts : 0) << system.index();
    if (looks == 0) continue;
    looks = 0;
    const auto stopped = [&looks] { return ++looks > 10; };
    EXPECT_TRUE(absl::IsCancelled(SolveSceneBounds(With(system), std::nullopt, stopped).status())) << system.index();
    EXPECT_EQ(looks, 11);
  }
}

TEST(SceneBoundsTest, EverySystemHasBoundsThatHoldItsImpacts) {
  for (const System& system : Systems()) {
    SCOPED_TRACE(system.index());
    const Scene scene = With(system);
    const CoefficientBounds sharp = Ask(scene).bounds.sharp;
    for (const double energetic : {0.0, 0.25, 0.5, 1.0}) {
      const Coefficients at = SolveAt(scene, energetic);
      ExpectWithin(at.newton, sharp.newton, 1e-9);
      ExpectWithin(*at.poisson, sharp.poisson, 1e-9);
      ExpectWithin(*at.energetic, sharp.energetic, 1e-9);
      ExpectWithin(at.tangential, sharp.tangential, 1e-9);
    }
  }
}

TEST(SceneBoundsTest, BoundsInSpaceSayThatTheyAreSampled) {
  for (const System& system : Systems()) {
    const Bounds bounds = Ask(With(system)).bounds;
    EXPECT_EQ(bounds.sampled, IsInSpace(system));
    EXPECT_EQ(bounds.energy_only.has_value(), !IsInSpace(system));
    EXPECT_EQ(bounds.critical == CriticalFriction(), IsInSpace(system));
    EXPECT_FALSE(bounds.nearly_vertical.has_value());
    EXPECT_EQ(bounds.friction_ratio, 0.0);
    EXPECT_EQ(bounds.slope_ratio, 0.0);
  }
}

TEST(SceneBoundsTest, AContactInSpaceThatDecouplesHasTheBoundsInThePlane) {
  Scene space = With(SpatialContact{{2.5, 0.0, 1.5, 3.0, 0.0, 2.5}, {-1.0, 0.0}, -1.0});
  space.friction.kinetic_coefficient = 0.7;
  const CoefficientBounds sampled = Ask(space).bounds.sharp;
  const CoefficientBounds sharp = Ask(Rod()).bounds.sharp;
  EXPECT_NEAR(sampled.newton.upper, sharp.newton.upper, 1e-9);
  EXPECT_NEAR(sampled.poisson.upper, sharp.poisson.upper, 1e-9);
  EXPECT_NEAR(sampled.normal_total_n_s.lower, sharp.normal_total_n_s.lower, 1e-9);
  EXPECT_NEAR(sampled.normal_total_n_s.upper, sharp.normal_total_n_s.upper, 1e-9);
}

// An impact that ends where v falls to 0 has the smallest ratio of impulses of all. The nearest of 65 coefficients is
// 0.2031, whose ratio is 1.2966.
TEST(SceneBoundsTest, InSpaceTheyReachTheJumpWhereTheEndRecedes) {
  EXPECT_NEAR(Ask(WithEndThatRecedes()).bounds.sharp.tangential.lower, 1.2794394307, 1e-6);
}

TEST(SceneBoundsTest, ARodAt45DegreesByHand) {
  const Bounds bounds = Ask(Rod()).bounds;
  EXPECT_EQ(bounds.critical.stick, 0.6);
  EXPECT_EQ(bounds.critical.stop_compression, 1.0);
  EXPECT_EQ(bounds.critical.stop, 0.0);
  EXPECT_EQ(bounds.critical.reversal, 0.0);
  EXPECT_FALSE(bounds.critical.jam.has_value());
  EXPECT_EQ(bounds.sharp.energetic, (Range{0.0, 1.0}));
}

// The velocity lies beside the one direction in which impulses move the contact, and friction holds it.
TEST(SceneBoundsTest, AnImpactInSpaceThatDoesNotEndBoundsNothing) {
  const Scene scene = {.system = SpatialContact{{0.09, 0.12, 0.3, 0.16, 0.4, 1.0}, {1.0, 0.0}, -1.0},
                       .friction = {.kinetic_coefficient = 3.0},
                       .restitution = EnergeticCoefficient{0.45}};
  const absl::StatusOr<SolveResponse> impact = LocalSolver().Solve({.scene = scene});
  ASSERT_TRUE(impact.ok());
  EXPECT_EQ(impact->outcome.regime, Regime::kWedged);
  EXPECT_EQ(impact->outcome.accuracy.relative_error, std::numeric_limits<double>::infinity());
  const absl::Status status = LocalSolver().Bounds({.scene = scene, .ranges = {}}).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kOutOfRange);
  EXPECT_EQ(ReasonOf(status), ErrorReason::kNotEnded);
}

TEST(SceneBoundsTest, FrictionBySpeedCountsAtTheApproachSpeed) {
  Scene scene = Rod();
  scene.friction.kinetic_coefficient = 1.4;
  scene.friction.by_speed = PowerLaw{0.5, 1.0};
  EXPECT_EQ(Ask(scene).bounds.sharp, Ask(Rod()).bounds.sharp);
}

TEST(SceneBoundsTest, AMovingSurfaceCountsByRelativeVelocity) {
  Scene scene = Rod();
  std::get<PlanarContact>(scene.system).tangential_m_s = 1.0;
  scene.surface_velocity = SurfaceVelocity{{2.0}, 0.0};
  EXPECT_EQ(Ask(scene).bounds, Ask(Rod()).bounds);
}

TEST(SceneBoundsTest, ASeparatingContactHasNothingToBound) {
  Scene scene = Rod();
  std::get<PlanarContact>(scene.system).normal_m_s = 0.5;
  const Bounds bounds = Ask(scene).bounds;
  EXPECT_EQ(bounds.regime, Regime::kSeparating);
  EXPECT_EQ(bounds.sharp, CoefficientBounds());
  EXPECT_EQ(bounds.critical, CriticalFriction());
}

TEST(SceneBoundsTest, APendulumLocksAtItsCriticalFriction) {
  Scene scene = SomePendulum();
  const CriticalFriction critical = Ask(scene).bounds.critical;
  EXPECT_EQ(critical.stick, 3.0);
  scene.friction.kinetic_coefficient = 3.0;
  EXPECT_EQ(Ask(scene).bounds.regime, Regime::kLocked);
  scene.friction.kinetic_coefficient = std::nextafter(3.0, 0.0);
  EXPECT_EQ(Ask(scene).bounds.regime, Regime::kRebound);
  std::get<Pendulum>(scene.system).b_m = 0.0;
  EXPECT_EQ(Ask(scene).bounds.critical, CriticalFriction());
}

TEST(SceneBoundsTest, APendulumHasTheCriticalFrictionOfItsContact) {
  Scene moving = SomePendulum();
  moving.surface_velocity = SurfaceVelocity{{0.0}, 0.0};
  EXPECT_EQ(Ask(moving).bounds.critical, Ask(SomePendulum()).bounds.critical);
}

TEST(SceneBoundsTest, AnImpactLawIsRefused) {
  Scene scene = Rod();
  scene.restitution = std::monostate();
  scene.impact_law = WhittakerLaw{0.5};
  EXPECT_THAT(Refused(scene), ElementsAre(Violation{"impact_law", "is set: must not be, for bounds"}));
}

}  // namespace
}  // namespace ricochet
