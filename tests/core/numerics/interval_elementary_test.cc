// Sin, Cos and Pow of intervals: they contain the exact value at every member, and little else.

#include "core/numerics/interval_elementary.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "tests/support/oracles/arb.h"

namespace ricochet {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr slong kBits = 1300;

double Uniform(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

bool Holds(const Interval& x, const Ball& exact) { return Ball(x.lower) <= exact && exact <= Ball(x.upper); }

// A hundredth of them wider than a period, some close to the extremes, some far out.
Interval RandomAngles(std::mt19937_64& random) {
  const double scale = random() % 8 == 0 ? std::exp2(Uniform(random, 0.0, 60.0)) : 1.0;
  double low = scale * Uniform(random, -10.0, 10.0);
  if (random() % 4 == 0) low = std::round(low / (kPi / 2)) * (kPi / 2);
  const double width = std::exp2(Uniform(random, -60.0, 3.0));
  return {low, low + (random() % 8 == 0 ? 0.0 : width)};
}

TEST(IntervalElementaryTest, SineAndCosineHoldTheValueAtEveryAngle) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 10'000; ++i) {
    const Interval x = RandomAngles(random);
    const Interval sine = Sin(x);
    const Interval cosine = Cos(x);
    for (const double share : {0.0, 1.0, 0.5, Uniform(random, 0.0, 1.0)}) {
      const double at = std::clamp(x.lower + share * (x.upper - x.lower), x.lower, x.upper);
      ASSERT_TRUE(Holds(sine, Sin(Ball(at, kBits)))) << x.lower << ' ' << x.upper << ' ' << at;
      ASSERT_TRUE(Holds(cosine, Cos(Ball(at, kBits)))) << x.lower << ' ' << x.upper << ' ' << at;
    }
  }
}

TEST(IntervalElementaryTest, ExtremesInsideAreReachedAndThoseOutsideAreNot) {
  EXPECT_EQ(Sin(Interval(1.5, 1.6)).upper, 1.0);
  EXPECT_EQ(Sin(Interval(-1.6, -1.5)).lower, -1.0);
  EXPECT_EQ(Cos(Interval(-0.1, 0.1)).upper, 1.0);
  EXPECT_EQ(Cos(Interval(3.1, 3.2)).lower, -1.0);
  EXPECT_EQ(Sin(Interval(0.0, 7.0)), Interval(-1.0, 1.0));
  EXPECT_LT(Sin(Interval(1.6, 1.7)).upper, 0.9996);
  EXPECT_GT(Cos(Interval(3.2, 6.2)).lower, -0.9983);
  EXPECT_LT(Cos(Interval(3.2, 6.2)).upper, 0.9966);
}

TEST(IntervalElementaryTest, PointsStayWithinAFewUlp) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 10'000; ++i) {
    const double x = Uniform(random, -10.0, 10.0);
    for (const Interval& value : {Sin(Interval(x)), Cos(Interval(x)), Pow(Interval(std::fabs(x)), 0.7)}) {
      ASSERT_LE(value.upper - value.lower, 5 * 0x1p-52 * std::max(std::fabs(value.lower), std::fabs(value.upper)));
    }
  }
  EXPECT_EQ(Sin(Interval(0.0)), Interval(0.0));
  EXPECT_EQ(Cos(Interval(0.0)), Interval(1.0));
}

TEST(IntervalElementaryTest, PowerHoldsTheValueAtEveryMember) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 10'000; ++i) {
    const double low = std::exp2(Uniform(random, -20.0, 20.0));
    const Interval x(low, low * (1.0 + std::exp2(Uniform(random, -60.0, 3.0))));
    const double exponent = Uniform(random, -3.0, 3.0);
    const Interval power = Pow(x, exponent);
    for (const double share : {0.0, 1.0, Uniform(random, 0.0, 1.0)}) {
      const double at = std::clamp(x.lower + share * (x.upper - x.lower), x.lower, x.upper);
      ASSERT_TRUE(Holds(power, Pow(Ball(at, 200), Ball(exponent, 200)))) << at << ' ' << exponent;
    }
  }
}

TEST(IntervalElementaryTest, PowersOfZeroAndExponentsOfZeroAndOneAreExact) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(Pow(Interval(0.0, 1.0), 0.5), Interval(0.0, 1.0));
  EXPECT_EQ(Pow(Interval(0.0, 2.0), 0.0), Interval(1.0));
  EXPECT_EQ(Pow(Interval(0.1, 2.0), 1.0), Interval(0.1, 2.0));
  EXPECT_EQ(Pow(Interval(0.0, 1.0), -0.5), Interval(1.0, kInfinity));
}

}  // namespace
}  // namespace ricochet
