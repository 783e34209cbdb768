// Bounds of every system and of uncertain scenes.

#include "core/models/scene_bounds.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/laws/contact_bounds.h"
#include "core/local_solver.h"
#include "core/scene/reduction.h"
#include "tests/support/system_scenes.h"

namespace ricochet {
namespace {

using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;

// The rod at 45 degrees.
Scene Rod() {
  Scene scene = With(PlanarContact{2.5, 1.5, 2.5, -1.0, -1.0});
  scene.friction.kinetic_coefficient = 0.7;
  return scene;
}

Scene SomePendulum() { return With(Pendulum{1.0, 3.0, 1.0, -1.0}); }

BoundsResponse Ask(const Scene& scene, const std::vector<FieldRange>& ranges = {}) {
  const auto response = LocalSolver().Bounds({.scene = scene, .ranges = ranges});
  EXPECT_TRUE(response.ok()) << response.status();
  return response.value_or(BoundsResponse());
}

std::vector<Violation> Refused(const Scene& scene, const std::vector<FieldRange>& ranges = {}) {
  return ViolationsOf(LocalSolver().Bounds({.scene = scene, .ranges = ranges}).status());
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

TEST(SceneBoundsTest, EverySystemHasBoundsThatHoldItsImpacts) {
  for (const System& system : Systems()) {
    SCOPED_TRACE(system.index());
    const Scene scene = With(system);
    const CoefficientBounds sharp = Ask(scene).bounds.sharp;
    for (const double energetic : {0.0, 0.25, 0.5, 1.0}) {
      const Coefficients at = SolveAt(scene, energetic);
      ExpectWithin(at.newton, sharp.newton, 1e-9);
      ExpectWithin(at.poisson, sharp.poisson, 1e-9);
      ExpectWithin(at.energetic, sharp.energetic, 1e-9);
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

TEST(SceneBoundsTest, ARodAt45DegreesByHand) {
  const Bounds bounds = Ask(Rod()).bounds;
  EXPECT_EQ(bounds.critical.stick, 0.6);
  EXPECT_EQ(bounds.critical.stop_compression, 1.0);
  EXPECT_EQ(bounds.critical.stop, 0.0);
  EXPECT_EQ(bounds.critical.reversal, 0.0);
  EXPECT_FALSE(bounds.critical.jam.has_value());
  EXPECT_EQ(bounds.sharp.energetic, (Range{0.0, 1.0}));
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

// ---- Uncertain scenes ----

TEST(SceneEnclosureTest, WithoutRangesThereIsNone) { EXPECT_FALSE(Ask(Rod()).enclosure.has_value()); }

TEST(SceneEnclosureTest, LeavesTheBoundsOfTheSceneAsTheyAre) {
  EXPECT_EQ(Ask(Rod(), {{"friction.kinetic_coefficient", 0.1, 0.2}}).bounds, Ask(Rod()).bounds);
}

TEST(SceneEnclosureTest, OfAPendulumIsReachedAtItsCorners) {
  const Enclosure enclosure =
      Ask(SomePendulum(), {{"friction.kinetic_coefficient", 0.4, 0.6}, {"pendulum.a_m", 2.0, 3.0}}).enclosure.value();
  EXPECT_NEAR(enclosure.outer.poisson.upper, std::sqrt(2.6 / 1.4), 1e-14);
  EXPECT_NEAR(enclosure.outer.newton.upper, std::sqrt(2.6 / 3.4), 1e-14);
  EXPECT_LT(enclosure.excess, 1e-12);
}

TEST(SceneEnclosureTest, HoldsTheBoundsOfScenesOfTheBox) {
  const std::vector<FieldRange> ranges = {{"friction.kinetic_coefficient", 0.63, 0.77},
                                          {"planar_contact.w_tn_per_kg", 1.35, 1.65},
                                          {"planar_contact.tangential_m_s", -1.1, -0.9}};
  const Enclosure enclosure = Ask(Rod(), ranges).enclosure.value();
  EXPECT_LT(enclosure.excess, 0.01);
  EXPECT_GT(enclosure.boxes, 1);
  for (int i = 0; i < 1000; ++i) {
    Scene scene = Rod();
    auto& contact = std::get<PlanarContact>(scene.system);
    scene.friction.kinetic_coefficient = 0.63 + 0.14 * (i % 10) / 9.0;
    contact.w_tn_per_kg = 1.35 + 0.3 * (i / 10 % 10) / 9.0;
    contact.tangential_m_s = -1.1 + 0.2 * (i / 100) / 9.0;
    const CoefficientBounds sharp = Ask(scene).bounds.sharp;
    ExpectWithin(sharp.newton.upper, enclosure.outer.newton, 1e-15);
    ExpectWithin(sharp.poisson.upper, enclosure.outer.poisson, 1e-15);
    ExpectWithin(sharp.tangential.lower, enclosure.outer.tangential, 1e-15);
    ExpectWithin(sharp.tangential.upper, enclosure.outer.tangential, 1e-15);
    ExpectWithin(sharp.normal_total_n_s.upper, enclosure.outer.normal_total_n_s, 1e-15);
  }
}

TEST(SceneEnclosureTest, StaticFrictionFollowsKineticUnlessStated) {
  Scene scene = SomePendulum();
  const FieldRange kinetic = {"friction.kinetic_coefficient", 0.4, 0.6};
  const FieldRange fixed = {"friction.static_coefficient", 3.0, 3.0};
  EXPECT_GT(Ask(scene, {kinetic}).enclosure->outer.newton.upper, 0.8);
  EXPECT_EQ(Ask(scene, {kinetic, fixed}).enclosure->outer.newton.upper, 0.0);
  scene.friction.static_coefficient = 3.0;
  EXPECT_EQ(Ask(scene, {kinetic}).enclosure->outer.newton.upper, 0.0);
}

TEST(SceneEnclosureTest, IsInfiniteWhereFrictionMayLock) {
  const Enclosure enclosure = Ask(SomePendulum(), {{"friction.kinetic_coefficient", 2.9, 3.1}}).enclosure.value();
  EXPECT_EQ(enclosure.outer.poisson.upper, std::numeric_limits<double>::infinity());
  EXPECT_EQ(enclosure.excess, std::numeric_limits<double>::infinity());
}

TEST(SceneEnclosureTest, RefusesPathsThatItDoesNotKnow) {
  for (const char* path : {"pendulum.phi_rad", "restitution.energetic", "planar_contact.w_nn_per_kg", "mass", ""}) {
    const auto violations = Refused(SomePendulum(), {{path, 0.5, 0.6}});
    ASSERT_THAT(violations, ElementsAre(Field(&Violation::field, "ranges[0].path"))) << path;
    EXPECT_THAT(violations[0].description,
                HasSubstr("must be one of pendulum.inertia_kg_m2, pendulum.a_m, pendulum.b_m, "
                          "pendulum.omega_minus_rad_s, friction.kinetic_coefficient, friction.static_coefficient"));
  }
}

TEST(SceneEnclosureTest, RefusesAFieldTwice) {
  EXPECT_THAT(Refused(SomePendulum(), {{"pendulum.a_m", 1.0, 2.0}, {"pendulum.a_m", 1.0, 3.0}}),
              ElementsAre(Violation{"ranges[1].path", "= \"pendulum.a_m\": must not be that of ranges[0] too"}));
}

TEST(SceneEnclosureTest, EachEndKeepsTheRuleOfItsField) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_THAT(
      Refused(
          SomePendulum(),
          {{"pendulum.a_m", 0.0, infinity}, {"friction.kinetic_coefficient", nan, 1.0}, {"pendulum.b_m", 2.0, 1.0}}),
      ElementsAre(Violation{"ranges[0].low", "= 0: must be > 0"}, Violation{"ranges[0].high", "= inf: must be finite"},
                  Violation{"ranges[1].low", "= nan: must be finite"},
                  Violation{"ranges[2].high", "= 1: must be >= low = 2"}));
}

TEST(SceneEnclosureTest, RefusesSystemsThatItCannotEnclose) {
  const std::vector<FieldRange> ranges = {{"friction.kinetic_coefficient", 0.1, 0.2}};
  for (const System& system : Systems()) {
    if (std::holds_alternative<PlanarContact>(system)) continue;
    EXPECT_THAT(Refused(With(system), ranges),
                ElementsAre(Violation{"system", "has no enclosure: must be pendulum or planar_contact, with ranges"}));
  }
  Scene scene = Rod();
  scene.surface_velocity = SurfaceVelocity{{1.0}, 0.0};
  scene.friction.by_speed = PowerLaw{0.0, 1.0};
  EXPECT_THAT(Refused(scene, ranges),
              ElementsAre(Field(&Violation::field, "surface_velocity"), Field(&Violation::field, "friction.by_speed")));
}

TEST(SceneEnclosureTest, RefusesAWOfRankOne) {
  const Scene scene = With(PlanarContact{4.0, 2.0, 1.0, -2.0, -1.0});
  EXPECT_THAT(Refused(scene, {{"planar_contact.tangential_m_s", -2.1, -1.9}}),
              ElementsAre(Field(&Violation::field, "planar_contact")));
}

TEST(SceneEnclosureTest, RefusesABoxWithoutAValidScene) {
  EXPECT_THAT(Refused(Rod(), {{"planar_contact.w_tn_per_kg", 2.6, 2.7}}),
              ElementsAre(Field(&Violation::field, "ranges")));
  Scene scene = SomePendulum();
  scene.friction.static_coefficient = 0.5;
  EXPECT_THAT(Refused(scene, {{"friction.kinetic_coefficient", 0.6, 0.7}}),
              ElementsAre(Field(&Violation::field, "ranges")));
}

}  // namespace
}  // namespace ricochet
