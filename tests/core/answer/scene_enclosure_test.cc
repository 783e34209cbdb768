// Enclosures of uncertain scenes: of every planar system, over every field that a range may have.

#include "core/answer/scene_enclosure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/answer/scene_bounds.h"
#include "core/scene/field.h"
#include "core/scene/numbers.h"
#include "core/scene/validate.h"
#include "ricochet/solver.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet {
namespace {

constexpr int64_t kMostBoxes = 200'000;

bool Never() { return false; }

using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

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

std::vector<Violation> Refused(const Scene& scene, const std::vector<FieldRange>& ranges) {
  return ViolationsOf(LocalSolver().Bounds({.scene = scene, .ranges = ranges}).status());
}

void ExpectWithin(double value, const Range& range, double slack) {
  EXPECT_GE(value, range.lower - slack);
  EXPECT_LE(value, range.upper + slack);
}

// ---- Random scenes ----

class Random {
 public:
  explicit Random(uint64_t seed) : engine_(seed) {}
  size_t Below(size_t bound) { return engine_() % bound; }
  double Uniform(double low, double high) {
    return low + (high - low) * 0x1p-53 * static_cast<double>(engine_() >> 11);
  }
  double OfEitherSign(double low, double high) { return Below(2) == 0 ? Uniform(low, high) : -Uniform(low, high); }
  template <typename T>
  void Shuffle(std::vector<T>& list) {
    for (size_t i = list.size(); i > 1; --i) std::swap(list[i - 1], list[Below(i)]);
  }

 private:
  std::mt19937_64 engine_;
};

PlanarBody RandomBody(Random& random) {
  return {.mass_kg = random.Uniform(0.5, 2.0),
          .inertia_com_kg_m2 = random.Uniform(0.05, 0.5),
          .offset_t_m = random.OfEitherSign(0.05, 1.0),
          .offset_n_m = random.OfEitherSign(0.05, 1.0),
          .velocity_t_m_s = random.OfEitherSign(0.0, 2.0),
          .velocity_n_m_s = -random.Uniform(0.2, 2.0),
          .rate_rad_s = random.OfEitherSign(0.0, 1.0)};
}

System RandomChain(int links, Random& random) {
  Linkage linkage;
  for (int i = 0; i < links; ++i) {
    const double length = random.Uniform(0.5, 1.5);
    const double mass = random.Uniform(0.5, 2.0);
    linkage.links.push_back({.length_m = length,
                             .mass_kg = mass,
                             .com_m = length * random.Uniform(0.3, 0.7),
                             .inertia_com_kg_m2 = mass * length * length * random.Uniform(0.05, 0.15),
                             .theta_rad = random.OfEitherSign(0.1, 1.3),
                             .rate_rad_s = random.OfEitherSign(0.1, 2.0)});
  }
  return linkage;
}

System RandomContact(Random& random) {
  const double t = random.Uniform(0.7, 1.4);
  const double n = random.Uniform(0.7, 1.4);
  return PlanarContact{t * t, t * n * random.OfEitherSign(0.0, 0.8), n * n, random.OfEitherSign(0.0, 2.0),
                       -random.Uniform(0.1, 2.0)};
}

System RandomSystem(const std::string& kind, Random& random) {
  if (kind == "pendulum") {
    return Pendulum{random.Uniform(0.5, 2.0), random.Uniform(0.2, 1.0), random.OfEitherSign(0.1, 1.0),
                    -random.Uniform(0.2, 2.0)};
  }
  if (kind == "planar_body") return RandomBody(random);
  if (kind == "body_pair") return BodyPair{PlanarPair{RandomBody(random), RandomBody(random)}};
  if (kind == "planar_contact") return RandomContact(random);
  return RandomChain(kind.back() - '0', random);
}

bool IsValidForBounds(const Scene& scene) { return Validate(scene, RestitutionIs::kOptional).empty(); }

// Returns the regime of the elastic impact, unspecified if the scene is not valid.
Regime RegimeOf(const Scene& scene) {
  const auto bounds = IsValidForBounds(scene) ? SolveSceneBounds(scene, std::nullopt, Never) : Bounds();
  return bounds.ok() ? bounds->regime : Regime::kUnspecified;
}

// One that approaches and does not lock.
Scene RandomScene(const std::string& kind, Random& random) {
  while (true) {
    Scene scene = {.system = RandomSystem(kind, random)};
    scene.friction.kinetic_coefficient = random.Uniform(0.05, 1.2);
    if (random.Below(4) == 0) {
      scene.friction.static_coefficient = scene.friction.kinetic_coefficient * random.Uniform(1.2, 1.6);
    }
    const Regime regime = RegimeOf(scene);
    if (regime != Regime::kUnspecified && regime != Regime::kSeparating && regime != Regime::kLocked) return scene;
  }
}

double ValueOf(const Scene& scene, const std::string& path) {
  double value = std::numeric_limits<double>::quiet_NaN();
  if (path == "pendulum.phi_rad") {
    const auto& pendulum = std::get<Pendulum>(scene.system);
    return std::atan2(pendulum.a_m, pendulum.b_m);
  }
  VisitNumbers(scene, [&](const NumberPath& number, const double& stored, NumberRule /*rule*/) {
    if (number.Text() == path) value = stored;
  });
  return value;
}

FieldRange Around(const Scene& scene, const std::string& path, double relative) {
  const double value = ValueOf(scene, path);
  const double reach = relative * std::fabs(value);
  return {path, value - reach, value + reach};
}

// Draws up to three ranges from all that there may be and that the scene states.
std::vector<FieldRange> RandomRanges(const Scene& scene, double relative, Random& random) {
  std::vector<std::string> paths = FieldPaths(scene);
  random.Shuffle(paths);
  std::vector<FieldRange> ranges;
  for (const std::string& path : paths) {
    if (ranges.size() == 3) break;
    if (std::isnan(ValueOf(scene, path))) continue;
    ranges.push_back(Around(scene, path, relative));
    if (!CheckRanges(scene, ranges).empty()) ranges.pop_back();
  }
  return ranges;
}

Scene Inside(Scene scene, const std::vector<FieldRange>& ranges, Random& random) {
  const bool corner = random.Below(4) == 0;
  for (const FieldRange& range : ranges) {
    const double end = random.Below(2) == 0 ? range.low : range.high;
    ResolveField(range.path, scene)->Set(corner ? end : random.Uniform(range.low, range.high));
  }
  return scene;
}

std::string Text(const std::vector<FieldRange>& ranges) {
  std::string text;
  for (const FieldRange& range : ranges) {
    text += range.path + " [" + std::to_string(range.low) + ", " + std::to_string(range.high) + "] ";
  }
  return text;
}

Enclosure EncloseOrFail(const Scene& scene, const std::vector<FieldRange>& ranges) {
  const auto enclosure = EncloseScene(scene, ranges, kMostBoxes, Never);
  EXPECT_TRUE(enclosure.ok()) << enclosure.status() << Text(ranges);
  return enclosure.value_or(Enclosure());
}

// Allows for the rounding of the scene's own W and bounds.
bool Contains(const Range& outer, const Range& inner) {
  const auto slack = [](double end) { return std::isinf(end) ? 0.0 : 1e-13 * std::fabs(end); };
  return inner.lower >= outer.lower - slack(outer.lower) && inner.upper <= outer.upper + slack(outer.upper);
}

bool Contains(const CoefficientBounds& outer, const Bounds& bounds) {
  const CoefficientBounds& inner = bounds.sharp;
  if (!Contains(outer.normal_total_n_s, inner.normal_total_n_s)) return false;
  if (bounds.regime == Regime::kSeparating) return true;
  return Contains(outer.newton, inner.newton) && Contains(outer.poisson, inner.poisson) &&
         Contains(outer.energetic, inner.energetic) && Contains(outer.tangential, inner.tangential);
}

void ExpectContainment(const Scene& scene, const std::vector<FieldRange>& ranges, int samples, Random& random) {
  const Enclosure enclosure = EncloseOrFail(scene, ranges);
  for (int i = 0; i < samples; ++i) {
    const Scene sample = Inside(scene, ranges, random);
    if (!IsValidForBounds(sample)) continue;
    const auto bounds = SolveSceneBounds(sample, std::nullopt, Never);
    ASSERT_TRUE(bounds.ok()) << bounds.status();
    ASSERT_TRUE(Contains(enclosure.outer, *bounds)) << Text(ranges);
  }
}

class EveryPlanarSystem : public testing::TestWithParam<const char*> {
 protected:
  // Returns the number of scenes, which is smaller for chains, because these take longest.
  int Scenes() const { return std::string(GetParam()).starts_with("chain") ? 8 : 25; }
};
INSTANTIATE_TEST_SUITE_P(SceneEnclosureTest, EveryPlanarSystem,
                         testing::Values("pendulum", "planar_body", "body_pair", "planar_contact", "chain_1", "chain_2",
                                         "chain_3"),
                         [](const auto& one) { return std::string(one.param); });

TEST_P(EveryPlanarSystem, EnclosureContainsEveryScene) {
  Random random(1);
  for (int i = 0; i < Scenes(); ++i) {
    const Scene scene = RandomScene(GetParam(), random);
    const double reach = random.Below(2) == 0 ? 0.1 : std::exp2(-random.Uniform(4.0, 40.0));
    ExpectContainment(scene, RandomRanges(scene, reach, random), 200, random);
    ASSERT_FALSE(HasFatalFailure());
  }
}

TEST_P(EveryPlanarSystem, EnclosureContainsEverySceneWhereFrictionDependsOnSpeed) {
  Random random(5);
  for (int i = 0; i < Scenes() / 2; ++i) {
    Scene scene = RandomScene(GetParam(), random);
    scene.friction.by_speed = SpeedDependence(PowerLaw{0.2, random.Uniform(0.0, 2.0)});
    if (i % 2 == 0) scene.friction.by_speed = SpeedDependence(SpeedTable{{0.1, 0.5, 1.5}, {1.0, 0.8, 0.6}});
    if (!IsValidForBounds(scene)) continue;
    ExpectContainment(scene, RandomRanges(scene, 0.1, random), 200, random);
    ASSERT_FALSE(HasFatalFailure());
  }
}

// Attained is reached by scenes of the box, so that no sampling is needed to tell the excess.
TEST_P(EveryPlanarSystem, ThreeRangesOfTenPercentAreEnclosedToHalfAPercent) {
  Random random(7);
  int enclosed = 0;
  for (int i = 0; i < Scenes(); ++i) {
    const Scene scene = RandomScene(GetParam(), random);
    const std::vector<FieldRange> ranges = RandomRanges(scene, 0.1, random);
    const Enclosure enclosure = EncloseOrFail(scene, ranges);
    EXPECT_LE(enclosure.boxes, 200'000);
    // Some of its pendulums lock: there is no bound.
    if (std::isinf(enclosure.outer.poisson.upper)) continue;
    EXPECT_LE(enclosure.excess, 0.005) << Text(ranges);
    ++enclosed;
  }
  EXPECT_GE(enclosed, Scenes() * 3 / 4);
}

// ---- As wide as what is seen ----

void Include(const Range& range, Range& seen) {
  seen.lower = std::min(seen.lower, range.lower);
  seen.upper = std::max(seen.upper, range.upper);
}

double Wider(const Range& outer, const Range& seen) {
  return (outer.upper - outer.lower) / (seen.upper - seen.lower) - 1.0;
}

// Returns by how much the widest range is wider than its hull over `samples` scenes.
double WiderThanSeen(const Scene& scene, const std::vector<FieldRange>& ranges, int samples) {
  Random random(4);
  const CoefficientBounds outer = EncloseOrFail(scene, ranges).outer;
  CoefficientBounds seen = SolveSceneBounds(Inside(scene, ranges, random), std::nullopt, Never)->sharp;
  Scene sample = scene;
  std::vector<ricochet::Field> fields;
  for (const FieldRange& range : ranges) fields.push_back(*ResolveField(range.path, sample));
  for (int i = 0; i < samples; ++i) {
    for (size_t k = 0; k < ranges.size(); ++k) fields[k].Set(random.Uniform(ranges[k].low, ranges[k].high));
    const CoefficientBounds sharp = SolveSceneBounds(sample, std::nullopt, Never)->sharp;
    Include(sharp.newton, seen.newton);
    Include(sharp.poisson, seen.poisson);
    Include(sharp.tangential, seen.tangential);
    Include(sharp.normal_total_n_s, seen.normal_total_n_s);
  }
  return std::max({Wider(outer.newton, seen.newton), Wider(outer.poisson, seen.poisson),
                   Wider(outer.tangential, seen.tangential), Wider(outer.normal_total_n_s, seen.normal_total_n_s)});
}

TEST(SceneEnclosureTest, APendulumByItsAngleIsAtMostOnePercentWiderThanSamples) {
  const Scene scene = With(Pendulum{1.0, 0.9, 0.5, -1.0});
  EXPECT_LE(WiderThanSeen(scene,
                          {Around(scene, "pendulum.phi_rad", 0.1), Around(scene, "friction.kinetic_coefficient", 0.1),
                           Around(scene, "pendulum.omega_minus_rad_s", 0.1)},
                          100'000),
            0.01);
}

TEST(SceneEnclosureTest, ABodyIsAtMostOnePercentWiderThanSamples) {
  const Scene scene = With(Flat());
  EXPECT_LE(WiderThanSeen(scene,
                          {Around(scene, "planar_body.offset_t_m", 0.1), Around(scene, "planar_body.mass_kg", 0.1),
                           Around(scene, "friction.kinetic_coefficient", 0.1)},
                          100'000),
            0.01);
}

TEST(SceneEnclosureTest, AChainIsAtMostOnePercentWiderThanSamples) {
  const Scene scene = With(Linkage{{{1.0, 1.0, 0.5, 0.1, 0.4, -1.0}, {1.0, 1.0, 0.5, 0.1, 0.9, -1.0}}});
  EXPECT_LE(WiderThanSeen(
                scene,
                {Around(scene, "linkage.links[0].theta_rad", 0.1), Around(scene, "linkage.links[1].rate_rad_s", 0.1),
                 Around(scene, "friction.kinetic_coefficient", 0.1)},
                100'000),
            0.01);
}

// ---- What ranges may be ----

TEST(SceneEnclosureTest, AMovingSurfaceCountsByRelativeVelocity) {
  Scene moving = Rod();
  std::get<PlanarContact>(moving.system).tangential_m_s = 1.0;
  moving.surface_velocity = SurfaceVelocity{{2.0}, 0.0};
  const FieldRange friction = {"friction.kinetic_coefficient", 0.6, 0.8};
  const Enclosure expected = Ask(Rod(), {friction, {"planar_contact.tangential_m_s", -1.25, -0.75}}).enclosure.value();
  const Enclosure found = Ask(moving, {friction, {"surface_velocity.tangential_m_s[0]", 1.75, 2.25}}).enclosure.value();
  EXPECT_EQ(found.outer, expected.outer);
}

TEST(SceneEnclosureTest, ARangeMakesASurfaceMove) {
  const Enclosure still = Ask(Rod(), {{"planar_contact.normal_m_s", -1.25, -1.0}}).enclosure.value();
  const Enclosure moving = Ask(Rod(), {{"surface_velocity.normal_m_s", 0.0, 0.25}}).enclosure.value();
  EXPECT_EQ(still.outer, moving.outer);
}

TEST(SceneEnclosureTest, AChainOfOneLinkIsAPendulum) {
  const Scene chain = With(Linkage{{{2.0, 1.0, 1.0, 0.5, 0.9, -1.0}}});
  const Scene pendulum = With(Pendulum{1.5, 2.0 * std::sin(0.9), 2.0 * std::cos(0.9), -1.0});
  const FieldRange friction = {"friction.kinetic_coefficient", 0.3, 0.4};
  const Enclosure by_chain = Ask(chain, {friction, {"linkage.links[0].theta_rad", 0.8, 1.0}}).enclosure.value();
  const Enclosure by_pendulum = Ask(pendulum, {friction, {"pendulum.phi_rad", 0.8, 1.0}}).enclosure.value();
  EXPECT_NEAR(by_chain.outer.newton.upper, by_pendulum.outer.newton.upper, 1e-13);
  EXPECT_NEAR(by_chain.outer.poisson.upper, by_pendulum.outer.poisson.upper, 1e-13);
  EXPECT_NEAR(by_chain.outer.tangential.lower, by_pendulum.outer.tangential.lower, 1e-13);
  EXPECT_NEAR(by_chain.outer.normal_total_n_s.upper, by_pendulum.outer.normal_total_n_s.upper, 1e-12);
}

// x = mu |cot(phi)|, by hand.
TEST(SceneEnclosureTest, APendulumByItsAngleHasTheBoundsOfThePaper) {
  const Enclosure enclosure = Ask(SomePendulum(), {{"pendulum.phi_rad", 1.0, 1.2}}).enclosure.value();
  const double most = 0.5 / std::tan(1.0);
  const double least = 0.5 / std::tan(1.2);
  EXPECT_NEAR(enclosure.outer.poisson.upper, std::sqrt((1.0 + most) / (1.0 - most)), 0.005);
  EXPECT_NEAR(enclosure.outer.newton.upper, std::sqrt((1.0 - least) / (1.0 + least)), 0.005);
  EXPECT_NEAR(enclosure.outer.tangential.lower, -0.5 * most / (1.0 + std::sqrt(1.0 - most * most)), 0.005);
  EXPECT_EQ(enclosure.outer.tangential.upper, 0.5);
}

TEST(SceneEnclosureTest, AnAngleBehindThePinIsRefused) {
  EXPECT_TRUE(Ask(SomePendulum(), {{"pendulum.phi_rad", 3.0, std::numbers::pi}}).enclosure.has_value());
  EXPECT_THAT(Refused(SomePendulum(), {{"pendulum.phi_rad", 3.0, 3.3}}),
              ElementsAre(Violation{"ranges[0].high", "= 3.3: must be in (0, pi), in radians"}));
  EXPECT_THAT(Refused(SomePendulum(), {{"pendulum.phi_rad", 30.0, 45.0}}),
              ElementsAre(Violation{"ranges[0].low", "= 30: must be in (0, pi), in radians"},
                          Violation{"ranges[0].high", "= 45: must be in (0, pi), in radians"}));
}

TEST(SceneEnclosureTest, FrictionBySpeedIsEnclosedOverAllApproachSpeeds) {
  Scene scene = With(Pendulum{1.0, 1.0, 1.0, -1.0});
  scene.friction.by_speed = SpeedDependence(PowerLaw{0.5, 1.0});
  const Enclosure enclosure = Ask(scene, {{"pendulum.omega_minus_rad_s", -1.5, -0.5}}).enclosure.value();
  // mu = 0.5 (1 - 0.5 |w-|) in [0.125, 0.375]
  EXPECT_NEAR(enclosure.outer.poisson.upper, std::sqrt(1.375 / 0.625), 0.005);
  EXPECT_NEAR(enclosure.outer.newton.upper, std::sqrt(0.875 / 1.125), 0.005);
  EXPECT_LE(enclosure.excess, 0.005);
}

TEST(SceneEnclosureTest, ScenesWhoseFrictionWouldBeNegativeCountForNothing) {
  Scene scene = With(Pendulum{1.0, 1.0, 1.0, -1.0});
  scene.friction.by_speed = SpeedDependence(PowerLaw{0.5, 1.0});
  const Enclosure enclosure = Ask(scene, {{"pendulum.omega_minus_rad_s", -3.0, -1.0}}).enclosure.value();
  EXPECT_EQ(enclosure.outer.newton.upper, 1.0);
  EXPECT_NEAR(enclosure.outer.tangential.upper, 0.25, 0.005);
  EXPECT_THAT(Refused(scene, {{"pendulum.omega_minus_rad_s", -3.0, -2.5}}),
              ElementsAre(Field(&Violation::field, "ranges")));
}

TEST(SceneEnclosureTest, IsStoppedByItsCaller) {
  const Scene scene = With(Flat());
  const std::vector<FieldRange> ranges = {Around(scene, "planar_body.offset_t_m", 0.5),
                                          Around(scene, "planar_body.offset_n_m", 0.5),
                                          Around(scene, "planar_body.rate_rad_s", 0.5)};
  ASSERT_GT(EncloseOrFail(scene, ranges).boxes, 1000);
  int asked = 0;
  const auto stopped = EncloseScene(scene, ranges, kMostBoxes, [&] { return ++asked > 1; });
  EXPECT_EQ(stopped.status().code(), absl::StatusCode::kCancelled);
  EXPECT_LE(asked, 3);
}

// ---- What there is of them ----

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
  for (const char* path : {"planar_contact.w_nn_per_kg", "mass", ""}) {
    const auto violations = Refused(SomePendulum(), {{path, 0.5, 0.6}});
    ASSERT_THAT(violations, ElementsAre(Field(&Violation::field, "ranges[0].path"))) << path;
    EXPECT_THAT(violations[0].description,
                HasSubstr("must be a field that the scene states; `ricochet sweep --axis '?'` lists them"));
  }
}

TEST(SceneEnclosureTest, RefusesManyUnknownPathsBriefly) {
  const std::vector<FieldRange> ranges(100'000, FieldRange{"no.such.field", 0.0, 1.0});
  const std::vector<Violation> violations = CheckRanges(SomePendulum(), ranges);
  EXPECT_TRUE(IsFull(violations));
  EXPECT_LE(violations.size(), kMostViolations + 1);
}

TEST(SceneEnclosureTest, SaysWhyAFieldHasNoRange) {
  Scene scene = SomePendulum();
  scene.friction.by_speed = SpeedDependence(PowerLaw{0.1, 1.0});
  scene.restitution_by_speed = SpeedDependence(PowerLaw{0.1, 1.0});
  const std::pair<const char*, const char*> refusals[] = {
      {"restitution.energetic", "bounds hold for every coefficient of restitution"},
      {"restitution.newton", "bounds hold for every coefficient of restitution"},
      {"restitution.by_speed.power_law.alpha", "bounds hold for every coefficient of restitution"},
      {"friction.by_speed.power_law.alpha", "an enclosure takes friction.by_speed as it stands"},
      {"surface_velocity.normal_m_s",
       "an enclosure covers velocities in the range of a W of rank one, and the surface's motion takes them out of "
       "it"}};
  for (const auto& [path, reason] : refusals) {
    EXPECT_THAT(
        Refused(scene, {{path, 0.5, 0.6}}),
        ElementsAre(Violation{"ranges[0].path", std::string("= \"") + path + "\": must not have a range: " + reason}));
  }
}

TEST(SceneEnclosureTest, RefusesTwoRangesThatDriveOneField) {
  EXPECT_THAT(Refused(SomePendulum(), {{"pendulum.phi_rad", 1.0, 1.2}, {"pendulum.b_m", 1.0, 3.0}}),
              ElementsAre(Violation{"ranges[1].path",
                                    "= \"pendulum.b_m\": must not drive what ranges[0] drives, pendulum.phi_rad"}));
}

TEST(SceneEnclosureTest, RefusesAFieldTwice) {
  EXPECT_THAT(Refused(SomePendulum(), {{"pendulum.a_m", 1.0, 2.0}, {"pendulum.a_m", 1.0, 3.0}}),
              ElementsAre(Violation{"ranges[1].path", "= \"pendulum.a_m\": must not be that of ranges[0] too"}));
}

TEST(SceneEnclosureTest, EachEndKeepsTheRuleOfItsField) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = kInfinity;
  EXPECT_THAT(
      Refused(
          SomePendulum(),
          {{"pendulum.a_m", 0.0, infinity}, {"friction.kinetic_coefficient", nan, 1.0}, {"pendulum.b_m", 2.0, 1.0}}),
      ElementsAre(Violation{"ranges[0].low", "= 0: must be > 0"}, Violation{"ranges[0].high", "= inf: must be finite"},
                  Violation{"ranges[1].low", "= nan: must be finite"},
                  Violation{"ranges[2].high", "= 1: must be >= low = 2"}));
}

TEST(SceneEnclosureTest, RefusesSystemsInSpace) {
  for (const System& system : Systems()) {
    if (TangentialDirections(system) == 1) continue;
    EXPECT_THAT(Refused(With(system), {{"friction.kinetic_coefficient", 0.1, 0.2}}),
                ElementsAre(Violation{"system",
                                      "has no enclosure: must be one of pendulum, planar_body, body_pair.planar, "
                                      "linkage, planar_contact, mechanism in a plane, with ranges"}));
  }
}

TEST(SceneEnclosureTest, RefusesAMovingSurfaceForSystemsOfRankOne) {
  Scene scene = SomePendulum();
  scene.surface_velocity = SurfaceVelocity{{0.0}, 0.0};
  EXPECT_THAT(Refused(scene, {{"friction.kinetic_coefficient", 0.1, 0.2}}),
              ElementsAre(Field(&Violation::field, "surface_velocity")));
}

TEST(SceneEnclosureTest, RefusesAChainThatStaysStretched) {
  const Scene scene = With(Linkage{{{1.0, 1.0, 0.5, 0.1, 0.5, -1.0}, {1.0, 1.0, 0.5, 0.1, 0.5, -1.0}}});
  EXPECT_THAT(Refused(scene, {{"linkage.links[0].mass_kg", 0.9, 1.1}}),
              ElementsAre(Violation{
                  "linkage", "has a W of rank one: must have rank two, with ranges, or be stated as a pendulum"}));
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
