#include "client/cli/plot/plot_scale.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "client/cli/plot/plot_axis.h"

namespace ricochet::cli {
namespace {

using Values = std::vector<double>;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <typename Function>
Values Sampled(int count, double from, double to, Function function) {
  Values values;
  for (int i = 0; i < count; ++i) values.push_back(function(from + (to - from) * i / (count - 1)));
  return values;
}

Values Shuffled(Values values) {
  std::mt19937 random(1);
  std::shuffle(values.begin(), values.end(), random);
  return values;
}

// All values lie inside, and the ends are those of the values.
void ExpectWhole(const Values& values, bool log = false) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  const Scale expected{.any = true,
                       .log = log,
                       .least = *least,
                       .most = *most,
                       .count = static_cast<int64_t>(values.size()),
                       .lowest = *least,
                       .highest = *most};
  EXPECT_EQ(ScaleFor({Shuffled(values)}, false), expected);
}

TEST(PlotScale, ShowsAllValuesWhereNoneIsFarBeyondTheRest) {
  ExpectWhole(Sampled(100, -3, 5, [](double x) { return x; }));
  ExpectWhole(Sampled(100, -1, 1, [](double x) { return x * x; }));
  ExpectWhole(Sampled(100, 0, 1, [](double x) { return x * x * x; }));
  ExpectWhole(Sampled(500, 0, 9, [](double x) { return std::sin(x); }));
  ExpectWhole(Sampled(100, 0, 1, [](double x) { return x < 0.3 ? 0.0 : 1.0; }));
}

TEST(PlotScale, LeavesAPoleOut) {
  // 1 to 100, and 1670: six of 101 values are a few, and the middle part reaches from 7 to 95.
  Values values = Sampled(100, 1, 100, [](double x) { return x; });
  values.push_back(1670);
  const Scale scale = ScaleFor({Shuffled(values)}, false);
  const Scale expected{.any = true,
                       .log = false,
                       .least = 1,
                       .most = 100,
                       .count = 101,
                       .below = 0,
                       .above = 1,
                       .lowest = 1,
                       .highest = 1670};
  EXPECT_EQ(scale, expected);
  EXPECT_EQ(OutsideText(scale), "1 of 101 points lies above 100, up to 1670");
}

TEST(PlotScale, LeavesPolesOfBothSignsOut) {
  Values values = Sampled(200, -1, 1, [](double x) { return x; });
  values.insert(values.end(), {-70.0, 1e9});
  const Scale scale = ScaleFor({Shuffled(values)}, false);
  EXPECT_EQ(scale.least, -1);
  EXPECT_EQ(scale.most, 1);
  EXPECT_EQ(OutsideText(scale), "1 of 202 points lies above 1, up to 1×10⁹; 1 lies below -1, down to -70");
}

TEST(PlotScale, EndsAHeavyTailSoThatTheRestFillsAFifthOrMore) {
  const Values values = Sampled(1000, -1, 1, [](double x) { return 1.0 / x; });
  const Scale scale = ScaleFor({values}, false);
  // A twentieth of the values is beyond 1/0.1 on each side. A quarter of the 20 between is 5, rounded to a unit.
  EXPECT_NEAR(scale.most, 15.0, 1.0);
  EXPECT_NEAR(scale.least, -15.0, 1.0);
  EXPECT_LE(scale.above, 50);
  EXPECT_LE(scale.below, 50);
  EXPECT_EQ(scale.highest, *std::max_element(values.begin(), values.end()));
}

TEST(PlotScale, TakesLogarithmsOfValuesOverDecades) {
  ExpectWhole(Sampled(9, 2, 8, [](double x) { return std::pow(10.0, x); }), true);
  ExpectWhole(Sampled(1000, -300, 0, [](double x) { return std::pow(10.0, x); }), true);
  ExpectWhole(Sampled(100, -3, -1, [](double x) { return std::pow(10.0, x); }));
}

TEST(PlotScale, LeavesAPoleOfALogarithmicScaleOut) {
  Values values = Sampled(100, 0, 4, [](double x) { return std::pow(10.0, x); });
  values.push_back(1e60);
  const Scale scale = ScaleFor({Shuffled(values)}, false);
  EXPECT_TRUE(scale.log);
  EXPECT_EQ(scale.least, 1.0);
  EXPECT_EQ(scale.most, 10000.0);
  EXPECT_EQ(scale.highest, 1e60);
}

TEST(PlotScale, IsLinearWhereAValueIsZeroOrNegative) {
  for (const double value : {0.0, -1.0}) {
    Values values = Sampled(9, 2, 8, [](double x) { return std::pow(10.0, x); });
    values.push_back(value);
    EXPECT_FALSE(ScaleFor({values}, false).log);
  }
}

TEST(PlotScale, IgnoresWhatALogarithmicScaleThatIsAskedForCannotShow) {
  const Scale scale = ScaleFor({{-1.0, 0.0, 2.0, kNan, 3.0}}, true);
  const Scale expected{
      .any = true, .log = true, .least = 2, .most = 3, .count = 2, .below = 0, .above = 0, .lowest = 2, .highest = 3};
  EXPECT_EQ(scale, expected);
}

TEST(PlotScale, ShowsEqualValuesAndOneThatDiffers) {
  ExpectWhole(Values(100, 5.0));
  Values values(100, 5.0);
  values.push_back(1e6);
  ExpectWhole(values);
}

TEST(PlotScale, HasNoEndsWithoutValues) {
  EXPECT_EQ(ScaleFor({}, false), Scale{});
  EXPECT_EQ(ScaleFor({Values(100, kNan), {}}, false), Scale{});
  EXPECT_FALSE(ScaleFor({{-1.0, 0.0}}, true).any);
  EXPECT_FALSE(ScaleFor({{kInfinity}}, false).any);
}

TEST(PlotScale, CountsInfinityAsBeyondTheEnd) {
  const Scale scale = ScaleFor({{1.0, kInfinity, 2.0, -kInfinity, kNan}}, false);
  EXPECT_EQ(scale.least, 1.0);
  EXPECT_EQ(scale.most, 2.0);
  EXPECT_EQ(scale.count, 4);
  EXPECT_EQ(OutsideText(scale), "1 of 4 points lies above 2, up to inf; 1 lies below 1, down to -inf");
}

TEST(PlotScale, LeavesNothingOutOfFewValues) { ExpectWhole({1, 2, 3, 4, 5, 6, 7, 8, 1e6}); }

TEST(PlotScale, LosesNoCurveAmongSmallerOnes) {
  std::vector<Values> groups(30, Sampled(50, 0, 1, [](double x) { return x; }));
  groups.push_back(Sampled(50, 500, 600, [](double x) { return x; }));
  const Scale scale = ScaleFor(groups, false);
  EXPECT_EQ(scale.most, 600.0);
  EXPECT_EQ(scale.above, 0);
}

TEST(PlotScale, DoesNotTakeRoundingForTheRest) {
  // Zeros but for rounding, beside a small region of other values.
  Values values = Sampled(100, -1e-17, 1e-17, [](double x) { return x; });
  values.insert(values.end(), {0.5, 0.6, 0.7});
  ExpectWhole(values);
}

TEST(PlotScale, LeavesOnePoleOfAnySizeOut) {
  for (const double pole : {1e4, 1e16, 1e300}) {
    for (const double sign : {-1.0, 1.0}) {
      Values values = Sampled(100, 0, 1, [](double x) { return x; });
      values.push_back(sign * pole);
      const Scale scale = ScaleFor({values}, false);
      EXPECT_EQ(scale.least, 0.0);
      EXPECT_EQ(scale.most, 1.0);
      EXPECT_EQ(scale.below, sign < 0.0 ? 1 : 0);
      EXPECT_EQ(scale.above, sign < 0.0 ? 0 : 1);
    }
  }
}

TEST(PlotScale, LeavesAtMostATwentiethOutOnEachSide) {
  std::mt19937_64 random(7);
  for (int round = 0; round < 300; ++round) {
    const int count = std::uniform_int_distribution<int>(1, 300)(random);
    std::cauchy_distribution<double> heavy(0.0, std::pow(10.0, round % 7 - 3));
    Values values;
    for (int i = 0; i < count; ++i) values.push_back(round % 2 == 0 ? heavy(random) : std::abs(heavy(random)));
    const Scale scale = ScaleFor({values}, false);
    const int few = count < 10 ? 0 : (count + 19) / 20;
    EXPECT_LE(scale.below, few);
    EXPECT_LE(scale.above, few);
    EXPECT_EQ(scale.below == 0, scale.least == scale.lowest);
    EXPECT_EQ(scale.above == 0, scale.most == scale.highest);
    const auto inside = std::count_if(values.begin(), values.end(),
                                      [&](double value) { return scale.least <= value && value <= scale.most; });
    EXPECT_EQ(inside + scale.below + scale.above, count);
  }
}

TEST(PlotScale, MarksTheEndsThatValuesLieBeyond) {
  const Scale scale{.any = true,
                    .log = false,
                    .least = -1,
                    .most = 5.2,
                    .count = 100,
                    .below = 0,
                    .above = 3,
                    .lowest = -1,
                    .highest = 1670};
  const AxisRange range = RangeOf(scale, 0.1, 0.0);
  EXPECT_NEAR(range.lower, -1.62, 1e-12);
  EXPECT_EQ(range.upper, 5.2);
  const std::vector<Tick> ticks = {{0, "0"}, {2, "2"}, {4, "4"}, {5, "5"}};
  const std::vector<Tick> expected = {{0, "0"}, {2, "2"}, {4, "4"}, {5.2, "≥ 5.2"}};
  EXPECT_EQ(WithMarkedEnds(ticks, scale, range, 0.1), expected);
  EXPECT_EQ(WithMarkedEnds(ticks, ScaleFor({{0, 5.2}}, false), {0, 5.2}, 0.1), ticks);
}

TEST(PlotAxis, HasTicksForNumbersThatAreAllAlmostZero) {
  constexpr double kLeast = std::numeric_limits<double>::denorm_min();
  for (const double most : {kLeast, 1e-310, 9e-301}) {
    const AxisRange range = RangeFor(0.0, most, 0.05, 0.0, false);
    EXPECT_LT(range.lower, range.upper - 1.0);
    EXPECT_GE(TicksFor(range, 600, 8, false, false).size(), 2);
  }
}

TEST(PlotAxis, OfManyDecadesHasTwoTicksOnAShortLength) {
  for (int first = -40; first <= 0; ++first) {
    for (int last = first + 1; last <= 40; ++last) {
      const AxisRange range = {std::pow(10.0, first), std::pow(10.0, last)};
      EXPECT_GE(TicksFor(range, 60, 8, false, true).size(), 2) << first << " to " << last;
    }
  }
}

}  // namespace
}  // namespace ricochet::cli
