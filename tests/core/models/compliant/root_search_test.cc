// The first root of a sum of two sinusoids, against all its values on a fine grid.

#include "core/models/compliant/root_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace ricochet::compliant {
namespace {

double AmplitudeOf(const Signal& signal, const Frequencies& w) {
  const double slow = w.slow > 0.0 ? std::fabs(signal.b[1]) / w.slow : 0.0;
  return std::fabs(signal.a[0]) + std::fabs(signal.a[1]) + std::fabs(signal.b[0]) / w.fast + slow;
}

// The first time on the grid where f is clearly negative.
double FirstOnGrid(const Signal& signal, const Frequencies& w, double step, double horizon) {
  const double rounding = 1e-13 * AmplitudeOf(signal, w);
  for (double t = 0.0; t < horizon; t += step) {
    if (signal.At(w, t).f < -rounding) return t;
  }
  return kNever;
}

class RootSearchTest : public testing::Test {
 protected:
  double Uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

  Frequencies RandomFrequencies(int i) {
    const double slow = std::exp2(Uniform(-6.0, 0.0));
    return {.fast = 1.0, .slow = i % 10 == 0 ? 0.0 : i % 10 == 1 ? 1.0 : slow};
  }

  std::mt19937_64 random_{1};
};

TEST_F(RootSearchTest, FindsTheFirstChangeOfSignAndNoLaterOne) {
  int never = 0;
  for (int i = 0; i < 8'000; ++i) {
    const Frequencies w = RandomFrequencies(i);
    const double balance = std::exp2(Uniform(-4.0, 4.0));
    Signal signal = {.a = {Uniform(-1.0, 1.0), balance * Uniform(-0.2, 1.0)},
                     .b = {Uniform(-1.0, 1.0), balance * w.slow * Uniform(-1.0, 1.0)}};
    if (!(signal.a[0] + signal.a[1] > 0.0)) signal.a[1] = std::fabs(signal.a[0]) + 1e-3;
    const double root = RootSearch(signal, w).First({}, 60.0);
    const double on_grid = FirstOnGrid(signal, w, 0.02, 60.0);
    ASSERT_LE(root, on_grid) << i;
    if (root == kNever) {
      ++never;
      continue;
    }
    // A root, and f is positive on the way there: nothing on the grid contradicts it.
    ASSERT_LE(std::fabs(signal.At(w, root).f), 1e-13 * AmplitudeOf(signal, w)) << i;
    for (double t = 0.0; t < root * (1.0 - 1e-9); t += 0.02) {
      ASSERT_GE(signal.At(w, t).f, -1e-13 * AmplitudeOf(signal, w)) << i << " " << t;
    }
  }
  EXPECT_GT(never, 100);
}

// f = f' = 0 < f'' at the start, as a stick begins.
TEST_F(RootSearchTest, LeavesADoubleRootAtTheStartBehind) {
  for (int i = 0; i < 2'000; ++i) {
    const Frequencies w = {.fast = 1.0, .slow = std::exp2(Uniform(-6.0, -0.1))};
    const double slope = Uniform(-1.0, 1.0);
    const Signal signal = {.a = {-1.0, 1.0}, .b = {slope, -slope}};
    const double root = RootSearch(signal, w).First({.at_zero = true}, kNever);
    ASSERT_GT(root, 1e-3) << i;
    ASSERT_LE(std::fabs(signal.At(w, root).f), 1e-13 * AmplitudeOf(signal, w)) << i;
    for (double t = 0.01; t < std::min(root, 200.0) - 1e-6; t += 0.02) {
      ASSERT_GE(signal.At(w, t).f, 0.0) << i << " " << t;
    }
  }
}

TEST_F(RootSearchTest, LooksOnlyFromTheStartOn) {
  const Frequencies w = {.fast = 1.0, .slow = 0.0};
  const RootSearch search({.a = {1.0, 0.0}, .b = {0.0, 0.0}}, w);  // cos t
  const double first = std::numbers::pi / 2.0;
  EXPECT_NEAR(search.First({.time = 1.0}, kNever), first, 0x1p-49 * first);
  EXPECT_NEAR(search.First({.time = 5.0}, kNever), 5.0 * first, 0x1p-49 * 5.0 * first);
  EXPECT_EQ(search.First({.time = 2.0}, kNever), 2.0) << "negative there";
  EXPECT_EQ(search.First({.time = 1.0}, 1.0), kNever);
}

TEST_F(RootSearchTest, SkipsAMillionPeriodsInWhichTheSlowPartIsTooLarge) {
  const Frequencies w = {.fast = 1e6, .slow = 1.0};
  const Signal signal = {.a = {1e-3, 1.0}, .b = {0.0, 0.0}};
  const double root = RootSearch(signal, w).First({}, kNever);
  // cos t = 1e-3 at the earliest, and -1e-3 at the latest.
  EXPECT_NEAR(root, std::numbers::pi / 2.0, 1.1e-3);
  EXPECT_LE(std::fabs(signal.At(w, root).f), 1e-9);
  EXPECT_LE(root, std::acos(1e-3) + 2.0 * std::numbers::pi / w.fast);
}

TEST_F(RootSearchTest, TwoRootsCloseTogetherAreNotMissed) {
  for (const double depth : {1e-2, 1e-5, 1e-9, 1e-13}) {
    // 1 - (1 + depth) cos(t - pi) is below 0 for |t - pi| < sqrt(2 depth).
    const Frequencies w = {.fast = 1.0, .slow = 0.0};
    const Signal signal = {.a = {1.0 + depth, 1.0}, .b = {0.0, 0.0}};
    const double root = RootSearch(signal, w).First({}, kNever);
    EXPECT_NEAR(std::numbers::pi - root, std::sqrt(2.0 * depth), 0.02 * std::sqrt(2.0 * depth)) << depth;
  }
}

TEST_F(RootSearchTest, AnglesAreRightToTheErrorThatTheSearchAllowsFor) {
  for (int i = 0; i < 10'000; ++i) {
    const double angle = Uniform(-std::numbers::pi, std::numbers::pi);
    const double size = std::exp2(Uniform(-500.0, 500.0));
    ASSERT_NEAR(Angle(size * std::cos(angle), size * std::sin(angle)), angle, kAngleError);
  }
  EXPECT_EQ(Angle(0.0, 0.0), 0.0);
}

}  // namespace
}  // namespace ricochet::compliant
