// How often the 95 % intervals hold the truth, over data sets with normal errors, some of them with outliers.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "tests/core/fit/fit_cases.h"

namespace ricochet::fit {
namespace {

struct Data {
  const char* name;
  FitLoss loss;
  std::optional<double> loss_scale;
  double outliers = 0.0;     // The probability of an error that is ten times as large.
  double input_sigma = 0.0;  // That of the velocities before.
};

class Coverage : public testing::TestWithParam<Data> {};

TEST_P(Coverage, OfTheTruthIsNinetyFivePercent) {
  constexpr int kSets = 1000;
  Case given = ContactCase();
  // What is known of robust losses holds for many numbers.
  for (FitInput& input : given.inputs) {
    input.values.insert(input.values.end(), input.values.begin(), input.values.end());
    if (GetParam().input_sigma > 0.0) input.sigma = {GetParam().input_sigma};
  }
  FitRequest exact = Noiseless(given);
  exact.loss = GetParam().loss;
  exact.loss_scale = GetParam().loss_scale;
  Noise noise(20260517, GetParam().outliers);
  std::vector<int> covered(given.true_values.size(), 0);
  std::vector<int> near(covered);
  int refused = 0;
  for (int set = 0; set < kSets; ++set) {
    const absl::StatusOr<FitResponse> response = Fit(noise.AddedTo(exact), [] { return false; });
    ASSERT_TRUE(response.ok()) << response.status();
    refused += static_cast<int>(response->refused);
    for (size_t k = 0; k < covered.size(); ++k) {
      const FitEstimate& estimate = response->unknowns[k];
      ASSERT_EQ(estimate.low.kind, FitEndKind::kFound);
      ASSERT_EQ(estimate.high.kind, FitEndKind::kFound);
      const double truth = given.true_values[k];
      covered[k] += static_cast<int>(*estimate.low.value <= truth && truth <= *estimate.high.value);
      near[k] += static_cast<int>(std::fabs(estimate.value - truth) <= 1.959963984540054 * *estimate.sigma);
    }
  }
  for (size_t k = 0; k < covered.size(); ++k) {
    for (const int count : {covered[k], near[k]}) {
      EXPECT_GE(count, 0.93 * kSets) << given.unknowns[k].path;
      EXPECT_LE(count, 0.97 * kSets) << given.unknowns[k].path;
    }
  }
  if (GetParam().outliers == 0.0) {
    EXPECT_LE(refused, kSets / 50);
  }
}

INSTANTIATE_TEST_SUITE_P(Losses, Coverage,
                         testing::Values(Data{"Squares", FitLoss::kSquares, {}}, Data{"Huber", FitLoss::kHuber, {}},
                                         Data{"Cauchy", FitLoss::kCauchy, {}},
                                         Data{"NarrowHuber", FitLoss::kHuber, 0.5},
                                         Data{"NarrowCauchy", FitLoss::kCauchy, 1.0},
                                         Data{"HuberWithOutliers", FitLoss::kHuber, {}, 0.1},
                                         Data{"CauchyWithOutliers", FitLoss::kCauchy, {}, 0.1},
                                         Data{"UncertainInputs", FitLoss::kSquares, {}, 0.0, 0.02}),
                         [](const auto& of) { return std::string(of.param.name); });

// Rows that slide lie on the friction cone, which errors make them leave as often as not.
TEST(CoverageTest, ManyGoodRowsDoNotRefuseThePhysics) {
  constexpr int kSets = 60;
  Case given = ContactCase();
  given.inputs.resize(1);
  given.inputs[0].values.assign(200, 3.0);
  const FitRequest exact = Noiseless(given);
  Noise noise(20260518);
  int broken = 0;
  for (int set = 0; set < kSets; ++set) {
    const absl::StatusOr<FitResponse> response = Fit(noise.AddedTo(exact), [] { return false; });
    ASSERT_TRUE(response.ok()) << response.status();
    broken += static_cast<int>(std::any_of(response->rows.begin(), response->rows.end(),
                                           [](const FitRow& r) { return !r.broken_limits.empty(); }));
  }
  EXPECT_EQ(broken, 0);
}

}  // namespace
}  // namespace ricochet::fit
