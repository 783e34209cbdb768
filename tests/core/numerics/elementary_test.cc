// Elementary functions are close to the exact result for every argument, and have the same bits everywhere.

#include "core/numerics/elementary.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>

#include "tests/support/oracles/arb.h"

namespace ricochet {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr slong kBits = 1300;  // These bits suffice to reduce an argument of 2^1024 by multiples of pi.
constexpr slong kFewBits = 200;

class Random {
 public:
  explicit Random(uint64_t seed) : engine_(seed) {}
  uint64_t Below(uint64_t bound) { return engine_() % bound; }
  double Uniform(double low, double high) {
    return low + (high - low) * 0x1p-53 * static_cast<double>(engine_() >> 11);
  }
  double AnyDouble() {
    while (true) {
      const double x = std::bit_cast<double>(engine_());
      if (std::isfinite(x)) return x;
    }
  }
  // The arguments are everyday angles, any doubles, and the doubles on either side of the multiples of pi/2.
  double Angle() {
    switch (Below(3)) {
      case 0:
        return AnyDouble();
      case 1:
        return Uniform(-10.0, 10.0);
      default:
        return std::nextafter(static_cast<double>(Below(1'000'000)) * (std::numbers::pi / 2),
                              Below(2) ? kInfinity : 0.0);
    }
  }

 private:
  std::mt19937_64 engine_;
};

struct Worst {
  double ulps = 0.0;
  void Count(double computed, const Ball& exact) { ulps = std::max(ulps, ErrorInUlps(computed, exact)); }
};

TEST(ElementaryTest, SineAndCosineAreWithinOneUlpOfAnyAngle) {
  Random random(1);
  Worst sine;
  Worst cosine;
  for (int i = 0; i < 30'000; ++i) {
    const double x = random.Angle();
    sine.Count(Sin(x), Sin(Ball(x, kBits)));
    cosine.Count(Cos(x), Cos(Ball(x, kBits)));
  }
  // The double closest to a multiple of pi/2 (Muller, Elementary Functions, sec. 11.1) and the largest double.
  for (const double x : {std::ldexp(6381956970095103.0, 797), std::numeric_limits<double>::max()}) {
    sine.Count(Sin(x), Sin(Ball(x, kBits)));
    cosine.Count(Cos(x), Cos(Ball(x, kBits)));
  }
  EXPECT_LE(sine.ulps, kElementaryUlps);
  EXPECT_LE(cosine.ulps, kElementaryUlps);
}

TEST(ElementaryTest, ExponentialIsWithinOneUlpSubnormalResultsIncluded) {
  Random random(2);
  Worst worst;
  for (int i = 0; i < 50'000; ++i) {
    const double x = random.Below(2) ? random.Uniform(-746.0, 709.7) : std::exp2(-random.Uniform(0.0, 60.0));
    worst.Count(Exp(x), Exp(Ball(x, kFewBits)));
    worst.Count(Exp(-x), Exp(Ball(-x, kFewBits)));
  }
  EXPECT_LE(worst.ulps, kElementaryUlps);
}

TEST(ElementaryTest, LogarithmIsWithinOneUlpCloseToOneToo) {
  Random random(3);
  Worst worst;
  for (int i = 0; i < 50'000; ++i) {
    const double near = 1.0 + random.Uniform(-1.0, 1.0) * std::exp2(-random.Uniform(0.0, 53.0));
    const double x = random.Below(2) ? near : std::fabs(random.AnyDouble());
    if (x > 0.0) worst.Count(Log(x), Log(Ball(x, kFewBits)));
  }
  EXPECT_LE(worst.ulps, kElementaryUlps);
}

TEST(ElementaryTest, PowerIsWithinOneUlpOverTheWholeRange) {
  Random random(4);
  Worst worst;
  for (int i = 0; i < 50'000; ++i) {
    const double x = random.Below(2) ? std::fabs(random.AnyDouble()) : random.Uniform(0.0, 20.0);
    if (x == 0.0) continue;
    const double most = 745.0 / std::fabs(std::log(x));
    const double y = random.Below(2) ? random.Uniform(0.0, 5.0) : random.Uniform(-most, most);
    worst.Count(Pow(x, y), Pow(Ball(x, kFewBits), Ball(y, kFewBits)));
  }
  EXPECT_LE(worst.ulps, kElementaryUlps);
}

TEST(ElementaryTest, HypotenuseIsWithinOneUlpAndDoesNotOverflowOnTheWay) {
  Random random(5);
  Worst worst;
  for (int i = 0; i < 50'000; ++i) {
    const double x = random.Below(2) ? random.AnyDouble() : 1e-308 * random.Uniform(-4.0, 4.0);
    const double y = random.Below(4) ? x * random.Uniform(-1.0, 1.0) : random.AnyDouble();
    worst.Count(Hypot(x, y), Sqrt(Ball(x, 5000) * Ball(x) + Ball(y, 5000) * Ball(y)));
  }
  EXPECT_LE(worst.ulps, kElementaryUlps);
}

TEST(ElementaryTest, SomeResultsAreExact) {
  Random random(6);
  EXPECT_EQ(Sin(0.0), 0.0);
  EXPECT_EQ(Cos(0.0), 1.0);
  EXPECT_EQ(Exp(0.0), 1.0);
  EXPECT_EQ(Log(1.0), 0.0);
  for (int i = 0; i < 10'000; ++i) {
    const double x = std::fabs(random.AnyDouble());
    ASSERT_EQ(Pow(x, 0.0), 1.0);
    ASSERT_EQ(Pow(x, 1.0), x);
  }
  EXPECT_EQ(Pow(0.0, 0.5), 0.0);
  EXPECT_EQ(Pow(0.0, 0.0), 1.0);
}

TEST(ElementaryTest, LimitsAreThoseOfC) {
  EXPECT_EQ(Exp(710.0), kInfinity);
  EXPECT_EQ(Exp(-750.0), 0.0);
  EXPECT_EQ(Log(0.0), -kInfinity);
  EXPECT_EQ(Pow(10.0, 400.0), kInfinity);
  EXPECT_TRUE(std::isnan(Log(-1.0)));
  EXPECT_TRUE(std::isnan(Pow(-1.0, 0.5)));
  EXPECT_TRUE(std::isnan(Sin(kInfinity)));
}

// Every machine must reproduce this digest of 600,000 results: one last bit that differs changes it.
TEST(ElementaryTest, BitsAreTheSameOnEveryMachine) {
  Random random(7);
  uint64_t digest = 0xcbf29ce484222325;  // FNV-1a over the results, one by one.
  const auto add = [&](double result) { digest = (digest ^ std::bit_cast<uint64_t>(result)) * 0x100000001b3; };
  for (int i = 0; i < 100'000; ++i) {
    const double angle = random.Angle();
    const double x = random.Uniform(0.0, 20.0);
    const double y = random.Uniform(-5.0, 5.0);
    for (const double result : {Sin(angle), Cos(angle), Exp(y), Log(x), Pow(x, y), Hypot(x, y)}) add(result);
  }
  EXPECT_EQ(digest, 6104595771412691769u);
}

}  // namespace
}  // namespace ricochet
