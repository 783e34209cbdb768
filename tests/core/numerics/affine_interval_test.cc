// Slope forms: they contain the function at every point of the box, and get narrow with the square of its size.

#include "core/numerics/affine_interval.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/oracles/arb.h"

namespace ricochet {
namespace {

constexpr slong kBits = 200;

// Every operation, and each variable several times. N is a AffineInterval or a Ball.
template <typename N>
N Formula(const N& x, const N& y) {
  const N root = Sqrt(x * x + y);
  return (x - y) / (x * y + N(2.0)) + root * Sin(x - y) - Cos(y) / (N(3.0) + x) - x;
}

double Uniform(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

Interval Enclose(const Interval& x, const Interval& y) {
  SlopeParameters parameters;
  const AffineInterval x_form = AffineInterval::Parameter(x, parameters);
  return Formula(x_form, AffineInterval::Parameter(y, parameters)).range();
}

bool Holds(const Interval& x, const Ball& exact) { return Ball(x.lower) <= exact && exact <= Ball(x.upper); }

TEST(AffineIntervalTest, ContainsTheFunctionAtEveryPoint) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 2'000; ++i) {
    const double reach = std::exp2(-Uniform(random, 0.0, 50.0));
    const double x0 = Uniform(random, 1.0, 3.0);
    const double y0 = Uniform(random, 1.0, 3.0);
    const Interval x(x0 - reach, x0 + reach);
    const Interval y(y0 - reach, y0 + reach);
    const Interval range = Enclose(x, y);
    for (int k = 0; k < 10; ++k) {
      const double at_x = k < 4 ? (k % 2 == 0 ? x.lower : x.upper) : Uniform(random, x.lower, x.upper);
      const double at_y = k < 4 ? (k / 2 == 0 ? y.lower : y.upper) : Uniform(random, y.lower, y.upper);
      ASSERT_TRUE(Holds(range, Formula(Ball(at_x, kBits), Ball(at_y, kBits)))) << at_x << ' ' << at_y;
    }
  }
}

// x (1 - x) reaches 1/4 at most; interval arithmetic alone would say more by the reach, not by its square.
TEST(AffineIntervalTest, IsTooWideByTheSquareOfTheBoxOnly) {
  for (const double reach : {0x1p-3, 0x1p-6, 0x1p-12, 0x1p-20}) {
    SlopeParameters parameters;
    const AffineInterval x = AffineInterval::Parameter({0.5 - reach, 0.5 + reach}, parameters);
    const Interval range = (x * (AffineInterval(1.0) - x)).range();
    EXPECT_GE(range.upper, 0.25);
    EXPECT_LE(range.upper, 0.25 + 2.0 * reach * reach);
    EXPECT_LE(range.lower, 0.25 - reach * reach);
    EXPECT_GE(range.lower, 0.25 - 2.0 * reach * reach);
  }
}

TEST(AffineIntervalTest, WhatCancelsExactlyCancelsHere) {
  SlopeParameters parameters;
  const AffineInterval x = AffineInterval::Parameter({1.0, 3.0}, parameters);
  EXPECT_EQ((x - x).range(), Interval(0.0));
}

TEST(AffineIntervalTest, ParametersBeyondThoseWithSlopesCountAsIntervals) {
  SlopeParameters parameters;
  AffineInterval sum(0.0);
  for (size_t i = 0; i < SlopeParameters::kMostSlopes + 2; ++i) {
    sum = sum + AffineInterval::Parameter({1.0, 2.0}, parameters);
  }
  EXPECT_EQ(parameters.size(), SlopeParameters::kMostSlopes);
  EXPECT_EQ(sum.range(), Interval(10.0, 20.0));
}

TEST(AffineIntervalTest, PowersFollowTheirDerivative) {
  SlopeParameters parameters;
  const AffineInterval x = AffineInterval::Parameter({1.0 - 0x1p-10, 1.0 + 0x1p-10}, parameters);
  const Interval range = (Pow(x, 0.5) - x * AffineInterval(0.5)).range();  // Flat at 1.
  EXPECT_TRUE(Contains(range, 0.5));
  EXPECT_LE(range.upper - range.lower, 0x1p-20);
}

}  // namespace
}  // namespace ricochet
