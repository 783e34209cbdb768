// Grids: a point's index gives the value of each axis, and axes that break a rule are refused.

#include "core/types/grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/rows/axis_values.h"

namespace ricochet {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr int64_t kMaxPoints = int64_t{1} << 53;

Axis List(std::vector<double> values) { return {"pendulum.a_m", ListValues{std::move(values)}}; }
Axis Lin(double start, double stop, int64_t count) { return {"pendulum.a_m", Linspace{start, stop, count}}; }
Axis Log(double start, double stop, int64_t count) { return {"pendulum.a_m", Logspace{start, stop, count}}; }

std::vector<std::string> FieldsOf(const std::vector<Violation>& violations) {
  std::vector<std::string> fields;
  for (const Violation& violation : violations) fields.push_back(violation.field);
  return fields;
}

std::vector<int64_t> PositionsOf(const Grid& grid, int64_t index) {
  std::vector<int64_t> positions(grid.axes.size(), -1);
  AxisPositions(grid, index, absl::MakeSpan(positions));
  return positions;
}

TEST(GridTest, NoAxesAreOnePoint) {
  EXPECT_EQ(PointCount(Grid()), 1);
  EXPECT_EQ(PointCount({.combination = Combination::kZip}), 1);
  EXPECT_THAT(ValidateAxes(Grid()), IsEmpty());
}

TEST(GridTest, InAProductTheLastAxisRunsFastest) {
  for (const Combination combination : {Combination::kProduct, Combination::kUnspecified}) {
    const Grid grid = {.axes = {List({1, 2}), List({1, 2, 3}), List({1, 2, 3, 4})}, .combination = combination};
    ASSERT_EQ(PointCount(grid), 24);
    EXPECT_THAT(PositionsOf(grid, 0), ElementsAre(0, 0, 0));
    EXPECT_THAT(PositionsOf(grid, 1), ElementsAre(0, 0, 1));
    EXPECT_THAT(PositionsOf(grid, 4), ElementsAre(0, 1, 0));
    EXPECT_THAT(PositionsOf(grid, 12), ElementsAre(1, 0, 0));
    EXPECT_THAT(PositionsOf(grid, 23), ElementsAre(1, 2, 3));
  }
}

TEST(GridTest, EveryIndexOfAProductHasItsOwnPositions) {
  const Grid grid = {.axes = {Lin(0, 1, 3), Lin(0, 1, 5), Lin(0, 1, 7)}};
  for (int64_t i = 0; i < PointCount(grid); ++i) {
    const std::vector<int64_t> positions = PositionsOf(grid, i);
    EXPECT_EQ((positions[0] * 5 + positions[1]) * 7 + positions[2], i);
  }
}

TEST(GridTest, ZippedAxesAdvanceTogether) {
  const Grid grid = {.axes = {List({1, 2, 3}), Lin(0, 1, 3)}, .combination = Combination::kZip};
  EXPECT_EQ(PointCount(grid), 3);
  EXPECT_THAT(PositionsOf(grid, 2), ElementsAre(2, 2));
}

TEST(GridTest, LinspaceHasExactEndsAndEvenSteps) {
  EXPECT_EQ(AxisValue(Lin(0.1, 0.7, 4), 0), 0.1);
  EXPECT_EQ(AxisValue(Lin(0.1, 0.7, 4), 3), 0.7);
  EXPECT_NEAR(AxisValue(Lin(0.1, 0.7, 4), 1), 0.3, 1e-16);
  EXPECT_EQ(AxisValue(Lin(5.0, -5.0, 11), 5), 0.0);
  EXPECT_EQ(AxisValue(Lin(3.0, 9.0, 1), 0), 3.0);
  double only = 0.0;
  AxisValues(Lin(3.0, 9.0, 1), 0, absl::MakeSpan(&only, 1));
  EXPECT_EQ(only, 3.0);
}

// The values are those of numpy.linspace, which tests/client/cli/arrays_test.py asks for more.
TEST(GridTest, LinspaceIsZeroWhereItPassesThroughZero) {
  EXPECT_EQ(AxisValue(Lin(-0.1, 0.3, 5), 1), 0.0);
  EXPECT_EQ(AxisValue(Lin(-0.7, 0.7, 15), 7), 0.0);
  constexpr double kLeast = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(AxisValue(Lin(0.0, 3 * kLeast, 7), 3), 2 * kLeast);
}

TEST(GridTest, LinspaceAcrossTheWholeRangeOfDoublesDoesNotOverflow) {
  constexpr double kLargest = std::numeric_limits<double>::max();
  const Axis axis = Lin(-kLargest, kLargest, 5);
  EXPECT_EQ(AxisValue(axis, 0), -kLargest);
  EXPECT_EQ(AxisValue(axis, 2), 0.0);
  EXPECT_EQ(AxisValue(axis, 4), kLargest);
  EXPECT_DOUBLE_EQ(AxisValue(axis, 3), kLargest / 2);
}

TEST(GridTest, LogspaceHasExactEndsAndEvenRatios) {
  EXPECT_EQ(AxisValue(Log(1e-3, 1e3, 7), 0), 1e-3);
  EXPECT_EQ(AxisValue(Log(1e-3, 1e3, 7), 6), 1e3);
  EXPECT_EQ(AxisValue(Log(0.1, 0.7, 1), 0), 0.1);
  for (int64_t i = 0; i < 7; ++i) {
    EXPECT_NEAR(AxisValue(Log(1e-3, 1e3, 7), i) / std::pow(10.0, static_cast<double>(i - 3)), 1.0, 1e-14);
  }
  EXPECT_NEAR(AxisValue(Log(1e-300, 1e300, 3), 1), 1.0, 1e-12);
}

TEST(GridTest, AxesAreMonotonousAndStayWithinTheirEnds) {
  for (const Axis& axis : {Lin(0.1, 0.3, 1001), Log(0.1, 0.3, 1001), Lin(1.0, 1.0 + 0x1p-50, 1001)}) {
    double previous = AxisValue(axis, 0);
    for (int64_t i = 1; i < 1001; ++i) {
      EXPECT_GE(AxisValue(axis, i), previous);
      previous = AxisValue(axis, i);
    }
  }
}

TEST(GridTest, BillionsOfPointsCostNothing) {
  const Grid grid = {.axes = {Lin(0, 1, 1'000'000'000), Log(1, 2, 8'000'000)}};
  EXPECT_THAT(ValidateAxes(grid), IsEmpty());
  EXPECT_EQ(PointCount(grid), 8'000'000'000'000'000);
  EXPECT_THAT(PositionsOf(grid, 7'999'999'999'999'999), ElementsAre(999'999'999, 7'999'999));
  EXPECT_EQ(AxisValue(grid.axes[0], 999'999'999), 1.0);
  EXPECT_NEAR(AxisValue(grid.axes[0], 499'999'999), 0.5, 1e-9);
}

TEST(GridTest, ProductsBeyond2To53PointsAreRejected) {
  EXPECT_THAT(ValidateAxes({.axes = {Lin(0, 1, kMaxPoints)}}), IsEmpty());
  EXPECT_THAT(FieldsOf(ValidateAxes({.axes = {Lin(0, 1, kMaxPoints), Lin(0, 1, 2)}})), ElementsAre("axes"));
  // A product of 2^64 would wrap to 0, and so would 2^66.
  const Axis huge = Lin(0, 1, int64_t{1} << 32);
  EXPECT_THAT(FieldsOf(ValidateAxes({.axes = {huge, huge}})), ElementsAre("axes"));
  const Axis large = Lin(0, 1, int64_t{1} << 22);
  EXPECT_THAT(FieldsOf(ValidateAxes({.axes = {large, large, large}})), ElementsAre("axes"));
}

TEST(GridTest, ZippedAxesMustBeEquallyLong) {
  const Grid grid = {.axes = {Lin(0, 1, 3), Lin(0, 1, 4)}, .combination = Combination::kZip};
  const std::vector<Violation> violations = ValidateAxes(grid);
  ASSERT_THAT(FieldsOf(violations), ElementsAre("axes"));
  EXPECT_THAT(violations[0].description, testing::AllOf(testing::HasSubstr("3"), testing::HasSubstr("4")));
}

TEST(GridTest, PathsOfZippedAxesAreEscapedAndCutInTheReason) {
  Grid grid = {.axes = {Lin(0, 1, 3), Lin(0, 1, 4)}, .combination = Combination::kZip};
  grid.axes[0].path = "friction\x1ependulum.a_m\x1f= 1";  // The separators of a list of violations.
  grid.axes[1].path = std::string(1000, 'x');
  const std::vector<Violation> violations = ViolationsOf(InvalidRequest(ValidateAxes(grid)));
  ASSERT_THAT(FieldsOf(violations), ElementsAre("axes"));
  EXPECT_THAT(violations[0].description,
              testing::HasSubstr("3 values of friction\\036pendulum.a_m\\037= 1 and 4 of x"));
  EXPECT_LT(violations[0].description.size(), 200);
}

TEST(GridTest, UnknownCombinationIsRejected) {
  EXPECT_THAT(FieldsOf(ValidateAxes({.axes = {Lin(0, 1, 3)}, .combination = static_cast<Combination>(9)})),
              ElementsAre("combination"));
}

struct BadAxis {
  Axis axis;
  std::string field;
};

TEST(GridTest, EachBrokenRuleOfAnAxisIsReportedWithItsPath) {
  const BadAxis cases[] = {
      {{"pendulum.a_m", std::monostate()}, "axes[0].values"},
      {List({}), "axes[0].list.values"},
      {List({1.0, kNan}), "axes[0].list.values[1]"},
      {List({-kInfinity}), "axes[0].list.values[0]"},
      {Lin(kNan, 1, 2), "axes[0].linspace.start"},
      {Lin(0, kInfinity, 2), "axes[0].linspace.stop"},
      {Lin(0, 1, 0), "axes[0].linspace.count"},
      {Lin(0, 1, -5), "axes[0].linspace.count"},
      {Lin(0, 1, kMaxPoints + 1), "axes[0].linspace.count"},
      {Log(0.0, 1, 2), "axes[0].logspace.start"},
      {Log(-1.0, 1, 2), "axes[0].logspace.start"},
      {Log(1.0, kInfinity, 2), "axes[0].logspace.stop"},
      {Log(1.0, kNan, 2), "axes[0].logspace.stop"},
      {Log(1.0, 2.0, 0), "axes[0].logspace.count"},
      {Log(1.0, 2.0, std::numeric_limits<int64_t>::min()), "axes[0].logspace.count"},
  };
  for (const BadAxis& bad : cases) {
    EXPECT_THAT(FieldsOf(ValidateAxes({.axes = {bad.axis}})), ElementsAre(bad.field)) << bad.field;
  }
}

TEST(GridTest, ViolationsOfAllAxesAreReportedAtOnce) {
  EXPECT_THAT(
      FieldsOf(ValidateAxes({.axes = {Lin(kNan, kNan, 0), List({1.0}), List({})}})),
      ElementsAre("axes[0].linspace.start", "axes[0].linspace.stop", "axes[0].linspace.count", "axes[2].list.values"));
}

}  // namespace
}  // namespace ricochet
