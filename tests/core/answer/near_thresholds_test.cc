// The nearest thresholds against closed forms of the planar impact, and against the impacts on both sides of them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "core/answer/derivatives.h"
#include "ricochet/solver.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet {
namespace {

constexpr char kFriction[] = "friction.kinetic_coefficient";
constexpr char kTangential[] = "planar_contact.tangential_m_s";
constexpr char kNormal[] = "planar_contact.normal_m_s";
constexpr char kOf[] = "contact_velocity_after.tangential_m_s[0]";

std::vector<Derivative> DerivativesOf(const Scene& scene, std::vector<std::string> by) {
  const absl::StatusOr<SolveResponse> answer = LocalSolver().Solve(
      {.scene = scene, .derivatives = DerivativePaths{.of = {kOf}, .by = std::move(by), .find_thresholds = true}});
  EXPECT_TRUE(answer.ok()) << answer.status();
  return answer.ok() ? answer->outcome.derivatives : std::vector<Derivative>();
}

// A contact that approaches at 1 m/s and slips forward at u, with Poisson's coefficient e.
struct Slip {
  double w_tt, w_tn, w_nn, u, mu, e;

  Scene Stated() const {
    return {
        .system =
            PlanarContact{
                .w_tt_per_kg = w_tt, .w_tn_per_kg = w_tn, .w_nn_per_kg = w_nn, .tangential_m_s = u, .normal_m_s = -1.0},
        .friction = {.kinetic_coefficient = mu},
        .restitution = PoissonCoefficient{e}};
  }
  // While it slips, u - (mu w_tt - w_tn) tau and -1 + (w_nn - mu w_tn) tau are the velocities at the normal impulse
  // tau. The friction at which slip stops where tau is `times` that of compression:
  double FrictionThatStops(double times) const { return (u * w_nn + times * w_tn) / (times * w_tt + u * w_tn); }
  // Returns the slip for which it does.
  double SlipThatStops(double times) const { return times * (mu * w_tt - w_tn) / (w_nn - mu * w_tn); }
};

Slip RandomSlip(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Slip slip = {.w_tt = 1.0 + 3.0 * unit(random), .w_nn = 1.0 + unit(random)};
  slip.w_tn = (unit(random) - 0.5) * std::sqrt(slip.w_tt * slip.w_nn);
  slip.u = 0.1 + unit(random);
  slip.mu = 0.02 + 0.7 * unit(random);
  slip.e = 0.1 + 0.8 * unit(random);
  return slip;
}

// The numbers among `all` that lie nearest to `number` on both sides.
struct Neighbours {
  std::optional<double> below, above;
};
Neighbours NeighboursOf(double number, const std::vector<double>& all) {
  Neighbours found;
  for (const double one : all) {
    if (one < number && one > found.below.value_or(-INFINITY)) found.below = one;
    if (one > number && one < found.above.value_or(INFINITY)) found.above = one;
  }
  return found;
}

void ExpectNear(const std::optional<NearThreshold>& found, const std::optional<double>& wanted, double number) {
  if (wanted.has_value() && std::fabs(*wanted - number) > 512.0 * number) return;  // The search may have ended.
  ASSERT_EQ(found.has_value(), wanted.has_value()) << number;
  if (found.has_value()) {
    EXPECT_NEAR(found->distance, std::fabs(*wanted - number), 1e-13 * (number + found->distance));
  }
}

TEST(NearThresholds, OfASlidingContactAreThoseOfTheClosedForm) {
  std::mt19937_64 random(20261126);
  int compression_ends = 0, friction_limits = 0;
  for (int i = 0; i < 1000; ++i) {
    const Slip slip = RandomSlip(random);
    SCOPED_TRACE(i);
    const double end = slip.FrictionThatStops(1.0 + slip.e), compression = slip.FrictionThatStops(1.0);
    std::vector<double> frictions = {0.0, end, compression};
    // Behind the stop friction holds the contact from |w_tn|/w_tt on. That limit is below where w_tn lets slip stop.
    const double limit = std::fabs(slip.w_tn) / slip.w_tt;
    if (slip.w_tn < 0.0 && limit > end) frictions.push_back(limit);
    std::vector<double> slips = {0.0};
    for (const double times : {1.0, 1.0 + slip.e}) slips.push_back(slip.SlipThatStops(times));
    const std::vector<Derivative> found = DerivativesOf(slip.Stated(), {kFriction, kTangential});
    ASSERT_EQ(found.size(), 2u);
    const Neighbours by_friction = NeighboursOf(slip.mu, frictions);
    ExpectNear(found[0].below, by_friction.below, slip.mu);
    ExpectNear(found[0].above, by_friction.above, slip.mu);
    const Neighbours by_slip = NeighboursOf(slip.u, slips);
    ExpectNear(found[1].below, by_slip.below, slip.u);
    ExpectNear(found[1].above, by_slip.above, slip.u);
    for (const Derivative& one : found) {
      for (const auto& near : {one.below, one.above}) {
        compression_ends += near.has_value() && near->threshold == Threshold::kCompressionEnd ? 1 : 0;
        friction_limits += near.has_value() && near->threshold == Threshold::kFrictionLimit ? 1 : 0;
      }
    }
  }
  EXPECT_GT(compression_ends, 100);
  EXPECT_GT(friction_limits, 10);
}

// Slip starts from rest towards -t while Wtn < -mu Wtt, sticks up to mu Wtt, and starts towards +t beyond.
TEST(NearThresholds, SlipThatStartsTheOtherWayIsAnotherCourse) {
  constexpr double kWtt = 1.1747700075286178, kWtn = -0.8451400197890777, kMu = 0.06822621901620496;
  const Scene scene = {.system = PlanarContact{.w_tt_per_kg = kWtt,
                                               .w_tn_per_kg = kWtn,
                                               .w_nn_per_kg = 0.7373908900631734,
                                               .normal_m_s = -0.5073852644091676},
                       .friction = {.kinetic_coefficient = kMu},
                       .restitution = NewtonCoefficient{0.0}};
  const std::vector<Derivative> found = DerivativesOf(scene, {"planar_contact.w_tn_per_kg"});
  ASSERT_EQ(found.size(), 1U);
  ASSERT_TRUE(found[0].above.has_value());
  EXPECT_EQ(found[0].above->threshold, Threshold::kFrictionLimit);
  EXPECT_NEAR(found[0].above->distance, -kWtn - kMu * kWtt, 1e-12);
}

// Without friction slip from rest changes its direction smoothly.
TEST(NearThresholds, ASmoothContactHasNoneOfFriction) {
  const Scene scene = {
      .system = PlanarContact{.w_tt_per_kg = 1.0, .w_tn_per_kg = 0.3, .w_nn_per_kg = 1.0, .normal_m_s = -1.0},
      .restitution = NewtonCoefficient{0.5}};
  const std::vector<Derivative> found = DerivativesOf(scene, {"planar_contact.w_tn_per_kg"});
  ASSERT_EQ(found.size(), 1U);
  ASSERT_TRUE(found[0].below.has_value());
  EXPECT_NE(found[0].below->threshold, Threshold::kFrictionLimit);
}

TEST(NearThresholds, HaveTheirNames) {
  Slip slip = {.w_tt = 3.0, .w_tn = 0.5, .w_nn = 1.5, .u = 1.0, .mu = 0.25, .e = 0.5};
  const std::vector<Derivative> found = DerivativesOf(slip.Stated(), {kFriction, kTangential, kNormal});
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].below->threshold, Threshold::kDomain);
  EXPECT_NEAR(found[0].below->distance, 0.25, 1e-16);
  EXPECT_EQ(found[0].above->threshold, Threshold::kImpactEnd);
  EXPECT_EQ(found[1].below->threshold, Threshold::kImpactEnd);
  EXPECT_FALSE(found[1].above.has_value());
  // A contact that approaches less and less comes to rest, and faster and faster stops its slip.
  EXPECT_EQ(found[2].above->threshold, Threshold::kApproach);
  EXPECT_NEAR(found[2].above->distance, 1.0, 1e-15);
  EXPECT_EQ(found[2].below->threshold, Threshold::kImpactEnd);
  EXPECT_NEAR(found[2].below->distance, 1.0 / slip.SlipThatStops(1.5) - 1.0, 1e-13);
}

// At mu = 1 slip stops just where compression ends, at a double that is hit exactly.
TEST(NearThresholds, OneThatIsHitExactlyHasTheNameOfItsNeighbours) {
  for (const double mu : {0.6, 1.2}) {
    const Slip slip = {.w_tt = 2.0, .w_tn = 1.0, .w_nn = 2.0, .u = -1.0, .mu = mu, .e = 0.5};
    const Derivative found = DerivativesOf(slip.Stated(), {kFriction}).front();
    const std::optional<NearThreshold>& near = mu < 1.0 ? found.above : found.below;
    ASSERT_TRUE(near.has_value());
    EXPECT_EQ(near->threshold, Threshold::kCompressionEnd) << mu;
    EXPECT_NEAR(near->distance, std::fabs(1.0 - mu), 1e-15);
  }
}

// The friction that holds is that of sliding where the scene states none of its own, and cannot be less.
TEST(NearThresholds, OfTheStaticFrictionThatIsNotStated) {
  const Slip slip = {.w_tt = 3.0, .w_tn = -1.2, .w_nn = 1.5, .u = 0.1, .mu = 0.3, .e = 0.5};
  const std::vector<Derivative> found = DerivativesOf(slip.Stated(), {"friction.static_coefficient"});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].below, (NearThreshold{Threshold::kDomain, 0.0}));
  EXPECT_EQ(found[0].above->threshold, Threshold::kFrictionLimit);
  EXPECT_NEAR(found[0].above->distance, 1.2 / 3.0 - 0.3, 1e-15);
}

TEST(NearThresholds, OfATableBySpeedAreItsSpeeds) {
  Scene scene = Slip{.w_tt = 3.0, .w_tn = 0.0, .w_nn = 1.5, .u = 100.0, .mu = 0.25, .e = 0.5}.Stated();
  scene.restitution_by_speed = SpeedTable{.speed_m_s = {0.5, 0.75, 4.0}, .factor = {1.0, 0.9, 0.8}};
  const std::vector<Derivative> found = DerivativesOf(scene, {kNormal});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].below, (NearThreshold{Threshold::kSpeedTable, 3.0}));
  EXPECT_EQ(found[0].above->threshold, Threshold::kSpeedTable);
  EXPECT_NEAR(found[0].above->distance, 0.25, 1e-15);
}

// Returns the regime and the events of the answer, by which courses differ.
std::vector<int> CourseAt(const Scene& scene) {
  const absl::StatusOr<SolveResponse> answer = LocalSolver().Solve({.scene = scene});
  if (!answer.ok()) return {};
  std::vector<int> course = {static_cast<int>(answer->outcome.regime)};
  for (const Event& event : answer->outcome.timeline) course.push_back(static_cast<int>(event.kind));
  return course;
}

TEST(NearThresholds, LieWhereTheCourseChangesInEveryModel) {
  const Scene rigid = Slip{.w_tt = 3.0, .w_tn = 0.5, .w_nn = 1.5, .u = 1.0, .mu = 0.25, .e = 0.5}.Stated();
  std::map<std::string, Scene> scenes;
  scenes["space"] = {
      .system =
          SpatialContact{.w_per_kg = {3.0, 0.2, 0.4, 2.5, 0.1, 1.5}, .tangential_m_s = {1.0, 0.0}, .normal_m_s = -1.0},
      .friction = {.kinetic_coefficient = 0.2},
      .restitution = EnergeticCoefficient{0.5}};
  scenes["tangential spring"] = rigid;
  scenes["tangential spring"].restitution = EnergeticCoefficient{0.5};
  scenes["tangential spring"].compliance = Compliance{.tangential_ratio_squared = 0.8};
  scenes["normal spring"] = rigid;
  scenes["normal spring"].restitution = EnergeticCoefficient{0.5};
  scenes["normal spring"].compliance = Compliance{.normal = LinearSpring{1e5}};
  for (const auto& [name, scene] : scenes) {
    SCOPED_TRACE(name);
    const std::vector<Derivative> found = DerivativesOf(scene, {kFriction});
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].below->threshold, Threshold::kDomain);
    ASSERT_TRUE(found[0].above.has_value());
    Scene before = scene, behind = scene;
    before.friction.kinetic_coefficient += found[0].above->distance * (1.0 - 1e-6);
    behind.friction.kinetic_coefficient += found[0].above->distance * (1.0 + 1e-6);
    EXPECT_EQ(CourseAt(before), CourseAt(scene));
    EXPECT_NE(CourseAt(behind), CourseAt(scene));
  }
}

TEST(NearThresholds, InSpaceTheEndMayRecede) {
  Scene scene = WithEndThatRecedes();
  scene.restitution = NewtonCoefficient{0.05};
  const std::vector<Derivative> found = DerivativesOf(scene, {"restitution.newton"});
  ASSERT_EQ(found.size(), 1U);
  ASSERT_TRUE(found[0].above.has_value());
  EXPECT_EQ(found[0].above->threshold, Threshold::kEndRecedes);
  EXPECT_NEAR(found[0].above->distance, 0.03227808 / 0.6307 - 0.05, 1e-8);
}

TEST(NearThresholds, AreRefusedForBounds) {
  const auto refused = LocalSolver().Bounds(
      {.scene = Slip{.w_tt = 3.0, .w_tn = 0.5, .w_nn = 1.5, .u = 1.0, .mu = 0.25, .e = 0.5}.Stated(),
       .derivatives = DerivativePaths{.of = {"sharp.newton.upper"}, .by = {kFriction}, .find_thresholds = true}});
  EXPECT_EQ(refused.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(refused.status().message(), testing::HasSubstr("derivatives.find_thresholds is set: must not be"));
}

}  // namespace
}  // namespace ricochet
