#include "core/numerics/interval.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "tests/support/oracles/arb.h"

namespace ricochet {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Every bit pattern of a finite double is as likely as any other.
double AnyDouble(std::mt19937_64& random) {
  const auto x = std::bit_cast<double>(uint64_t{random()});
  return std::isfinite(x) ? x : 1.0;
}

// Operands whose results have ordinary exponents, half of the time.
double Operand(std::mt19937_64& random) {
  return random() % 2 == 0 ? AnyDouble(random) : std::uniform_real_distribution<double>(-4.0, 4.0)(random);
}

bool AtLeastLower(const Interval& x, const Ball& exact) { return std::isinf(x.lower) || Ball(x.lower) <= exact; }
bool AtMostUpper(const Interval& x, const Ball& exact) { return std::isinf(x.upper) || exact <= Ball(x.upper); }

TEST(IntervalTest, ContainsTheExactResultOfPointsAndIsAtMostOneUlpWide) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 200'000; ++i) {
    const double a = Operand(random);
    const double b = Operand(random);
    const Interval results[] = {Interval(a) + Interval(b), Interval(a) - Interval(b), Interval(a) * Interval(b),
                                Square(Interval(a))};
    const Ball x(a, Ball::kExact);
    const Ball y(b, Ball::kExact);
    const Ball exact[] = {x + y, x - y, x * y, x * x};
    for (int k = 0; k < 4; ++k) {
      ASSERT_TRUE(AtLeastLower(results[k], exact[k]) && AtMostUpper(results[k], exact[k])) << a << ' ' << b << ' ' << k;
      const bool underflows = std::fabs(results[k].upper) < rounding::kErrorIsExact;
      const double next = std::nextafter(results[k].lower, kInfinity);
      ASSERT_LE(results[k].upper, underflows ? std::nextafter(next, kInfinity) : next) << a << ' ' << b << ' ' << k;
    }
  }
}

TEST(IntervalTest, ContainsTheExactQuotientAndRoot) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 100'000; ++i) {
    const double a = Operand(random);
    const double b = Operand(random);
    if (b == 0.0) continue;
    const Interval quotient = Interval(a) / Interval(b);
    const Ball exact = Ball(a, 3000) / Ball(b, 3000);
    ASSERT_TRUE(AtLeastLower(quotient, exact) && AtMostUpper(quotient, exact)) << a << ' ' << b;
    const Interval root = Sqrt(Interval(std::fabs(a)));
    const Ball exact_root = Sqrt(Ball(std::fabs(a), 3000));
    ASSERT_TRUE(AtLeastLower(root, exact_root) && AtMostUpper(root, exact_root)) << a;
  }
}

TEST(IntervalTest, ExactResultsStayPoints) {
  EXPECT_EQ(Interval(0.5) + Interval(0.25), Interval(0.75));
  EXPECT_EQ(Interval(3.0) * Interval(0.0), Interval(0.0));
  EXPECT_EQ(Interval(3.0) / Interval(4.0), Interval(0.75));
  EXPECT_EQ(Sqrt(Interval(2.25)), Interval(1.5));
  EXPECT_NE(Interval(0.1) + Interval(0.2), Interval(0.1 + 0.2));
}

TEST(IntervalTest, ProductsAndQuotientsTakeEverySignIntoAccount) {
  EXPECT_EQ(Interval(-2.0, 3.0) * Interval(-5.0, 4.0), Interval(-15.0, 12.0));
  EXPECT_EQ(Interval(-2.0, 3.0) / Interval(-4.0, -2.0), Interval(-1.5, 1.0));
  EXPECT_EQ(Square(Interval(-2.0, 1.0)), Interval(0.0, 4.0));
  EXPECT_EQ(Abs(Interval(-2.0, 1.0)), Interval(0.0, 2.0));
}

TEST(IntervalTest, DivisionThatComesNearZeroIsUnbounded) {
  EXPECT_EQ(Interval(1.0, 2.0) / Interval(0.0, 4.0), Interval(0.25, kInfinity));
  EXPECT_EQ(Interval(-2.0, -1.0) / Interval(0.0, 4.0), Interval(-kInfinity, -0.25));
  EXPECT_EQ(Interval(1.0, 2.0) / Interval(-1.0, 4.0), Interval(-kInfinity, kInfinity));
  EXPECT_EQ(Interval(0.0) / Interval(0.0, 4.0), Interval(0.0));
  EXPECT_EQ(Interval(1.0, kInfinity) * Interval(0.0, 2.0), Interval(0.0, kInfinity));
}

TEST(IntervalTest, OverflowKeepsTheLargestDoubleBelow) {
  const double largest = std::numeric_limits<double>::max();
  EXPECT_EQ(Interval(largest) + Interval(largest), Interval(largest, kInfinity));
  EXPECT_EQ(Interval(largest) * Interval(2.0), Interval(largest, kInfinity));
}

}  // namespace
}  // namespace ricochet
