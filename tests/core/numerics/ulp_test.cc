#include "tests/support/oracles/ulp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ricochet {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kLargest = std::numeric_limits<double>::max();
constexpr double kSmallest = std::numeric_limits<double>::denorm_min();

TEST(UlpDistanceTest, EqualNumbersAreAtDistanceZeroZerosOfBothSignsIncluded) {
  EXPECT_EQ(UlpDistance(0.1, 0.1), 0U);
  EXPECT_EQ(UlpDistance(0.0, -0.0), 0U);
  EXPECT_EQ(UlpDistance(-kInfinity, -kInfinity), 0U);
}

TEST(UlpDistanceTest, NeighboursAreAtDistanceOne) {
  for (const double x : {1.0, -1.0, 0.1, 1e300, 1e-300, 4e-320, kLargest, 0.0}) {
    EXPECT_EQ(UlpDistance(x, std::nextafter(x, kInfinity)), 1U) << x;
    EXPECT_EQ(UlpDistance(std::nextafter(x, -kInfinity), x), 1U) << x;
  }
}

TEST(UlpDistanceTest, DistancesRunThroughZero) {
  EXPECT_EQ(UlpDistance(-kSmallest, kSmallest), 2U);
  EXPECT_EQ(UlpDistance(3 * kSmallest, -2 * kSmallest), 5U);
}

TEST(UlpDistanceTest, ABinadeHolds2To52Doubles) {
  EXPECT_EQ(UlpDistance(1.0, 2.0), uint64_t{1} << 52);
  EXPECT_EQ(UlpDistance(-4.0, -2.0), uint64_t{1} << 52);
}

TEST(UlpDistanceTest, OppositeEndsDoNotWrapAround) {
  const uint64_t from_zero = UlpDistance(0.0, kInfinity);
  EXPECT_EQ(from_zero, uint64_t{0x7ff} << 52);
  EXPECT_EQ(UlpDistance(-kInfinity, kInfinity), 2 * from_zero);
}

TEST(UlpDistanceTest, NanIsComparableToNanOnly) {
  EXPECT_EQ(UlpDistance(kNan, -kNan), 0U);
  EXPECT_EQ(UlpDistance(kNan, 1.0), kNotComparable);
  EXPECT_EQ(UlpDistance(kInfinity, kNan), kNotComparable);
}

}  // namespace
}  // namespace ricochet
