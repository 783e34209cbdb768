// Compensated sums keep their bound on data whose terms cancel, in every lane and on every SIMD target.

#include "core/numerics/compensated_sums.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "hwy/targets.h"
#include "tests/support/only_target.h"
#include "tests/support/oracles/arb.h"

namespace ricochet {
namespace {

constexpr double kUnit = 0x1p-53;

// b - A x with entries of sizes from 2^-20 to 2^20, where b is A x rounded so that all but the rounding cancels.
struct Cancelling {
  explicit Cancelling(size_t n) : a(n * n), x(n), b(n) {
    std::mt19937_64 random(n);
    const auto number = [&random] {
      return std::ldexp(std::uniform_real_distribution<double>(-1.0, 1.0)(random),
                        static_cast<int>(random() % 41) - 20);
    };
    for (size_t i = 0; i < n; ++i) {
      x[i] = number();
      for (size_t j = 0; j <= i; ++j) a[i * n + j] = a[j * n + i] = number();
    }
    for (size_t i = 0; i < n; ++i) {
      for (size_t j = 0; j < n; ++j) b[i] += a[i * n + j] * x[j];
    }
  }
  std::vector<double> a, x, b;
};

Ball Exactly(double value) { return Ball(value, Ball::kExact); }

void ExpectResidualsWithinTheirBound() {
  for (size_t n = 1; n <= 20; ++n) {
    const Cancelling given(n);
    std::vector<double> residual(n), sizes(n);
    CompensatedResidual(given.a.data(), given.x.data(), given.b.data(), n, residual.data(), sizes.data());
    for (size_t i = 0; i < n; ++i) {
      Ball exact = Exactly(given.b[i]);
      double size = std::fabs(given.b[i]);
      for (size_t j = 0; j < n; ++j) {
        exact = exact - Exactly(given.a[i * n + j]) * Exactly(given.x[j]);
        size += std::fabs(given.a[i * n + j] * given.x[j]);
      }
      const double terms = static_cast<double>(n + 1) * kUnit;
      const double error = std::fabs((Exactly(residual[i]) - exact).Nearest());
      EXPECT_LE(error, kUnit * std::fabs(residual[i]) + 1.01 * terms * terms * size) << n << ", row " << i;
      EXPECT_NEAR(sizes[i], size, 1e-14 * size);
    }
  }
}

TEST(CompensatedSumsTest, ResidualsKeepTheirBoundOnEveryTarget) {
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    const OnlyTarget only(target);
    ExpectResidualsWithinTheirBound();
  }
}

TEST(CompensatedSumsTest, DotsKeepTheirBound) {
  const size_t n = 20;
  const Cancelling given(n);
  Ball exact = Exactly(0.0);
  for (size_t i = 0; i < n; ++i) exact = exact + Exactly(given.x[i]) * Exactly(given.b[i]);
  const CompensatedSum one = CompensatedDot(given.x.data(), given.b.data(), n);
  const double terms = 2.0 * static_cast<double>(n) * kUnit;
  EXPECT_LE(std::fabs((Exactly(one.value) - exact).Nearest()),
            kUnit * std::fabs(one.value) + 1.01 * terms * terms * one.size);
  // The second sum takes the first away, so that what it rounded is left.
  std::vector<double> minus(n, 0.0), unit(n, 0.0);
  minus[0] = -one.value;
  unit[0] = 1.0;
  const CompensatedSum both = CompensatedDots(given.x.data(), given.b.data(), minus.data(), unit.data(), n);
  const double left = (exact - Exactly(one.value)).Nearest();
  EXPECT_NEAR(both.value, left, kUnit * std::fabs(left) + 1.01 * terms * terms * both.size);
}

}  // namespace
}  // namespace ricochet
