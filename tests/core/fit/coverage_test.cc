// How often the 95 % intervals hold the truth, over data sets with normal errors.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/core/fit/fit_cases.h"

namespace ricochet::fit {
namespace {

TEST(CoverageTest, IntervalsCoverTheTruthInNinetyFivePercent) {
  constexpr int kSets = 1000;
  const Case given = ContactCase();
  const FitRequest exact = Noiseless(given);
  std::mt19937_64 random(20260517);
  std::normal_distribution<double> normal;
  std::vector<int> covered(given.true_values.size(), 0);
  int refused = 0;
  for (int set = 0; set < kSets; ++set) {
    FitRequest request = exact;
    for (FitMeasured& measured : request.measured) {
      for (double& value : measured.values) value += measured.sigma[0] * normal(random);
    }
    const absl::StatusOr<FitResponse> response = Fit(request, [] { return false; });
    ASSERT_TRUE(response.ok()) << response.status();
    refused += static_cast<int>(response->refused);
    for (size_t k = 0; k < covered.size(); ++k) {
      const FitEstimate& estimate = response->unknowns[k];
      ASSERT_EQ(estimate.low.kind, FitEndKind::kFound);
      ASSERT_EQ(estimate.high.kind, FitEndKind::kFound);
      covered[k] +=
          static_cast<int>(*estimate.low.value <= given.true_values[k] && given.true_values[k] <= *estimate.high.value);
    }
  }
  for (size_t k = 0; k < covered.size(); ++k) {
    EXPECT_GE(covered[k], 0.93 * kSets) << given.unknowns[k].path;
    EXPECT_LE(covered[k], 0.97 * kSets) << given.unknowns[k].path;
  }
  EXPECT_LE(refused, kSets / 50);
}

// Rows that slide lie on the friction cone, which errors make them leave as often as not.
TEST(CoverageTest, ManyGoodRowsDoNotRefuseThePhysics) {
  constexpr int kSets = 60;
  Case given = ContactCase();
  given.inputs.resize(1);
  given.inputs[0].values.assign(200, 3.0);
  const FitRequest exact = Noiseless(given);
  std::mt19937_64 random(20260518);
  std::normal_distribution<double> normal;
  int broken = 0;
  for (int set = 0; set < kSets; ++set) {
    FitRequest request = exact;
    for (FitMeasured& measured : request.measured) {
      for (double& value : measured.values) value += measured.sigma[0] * normal(random);
    }
    const absl::StatusOr<FitResponse> response = Fit(request, [] { return false; });
    ASSERT_TRUE(response.ok()) << response.status();
    broken += static_cast<int>(std::any_of(response->rows.begin(), response->rows.end(),
                                           [](const FitRow& r) { return !r.broken_limits.empty(); }));
  }
  EXPECT_EQ(broken, 0);
}

}  // namespace
}  // namespace ricochet::fit
