// Fits whose inputs have errors, against sums of squares that are written out here.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "tests/core/fit/fit_cases.h"

namespace ricochet::fit {
namespace {

constexpr char kBefore[] = "planar_contact.normal_m_s";
constexpr char kAfter[] = "contact_velocity_after.normal_m_s";
constexpr char kSlipAfter[] = "contact_velocity_after.tangential_m_s[0]";

const std::vector<double> kSpeeds = {-0.9, -1.6, -2.1, -2.4, -3.3, -4.1};
const std::vector<double> kReturned = {0.62, 0.87, 1.32, 1.29, 2.15, 2.33};

bool Never() { return false; }

PlanarContact Contact() { return {.w_tt_per_kg = 3.0, .w_nn_per_kg = 1.0, .tangential_m_s = 5.0, .normal_m_s = -1.0}; }

// y = -e x, with errors of both.
FitRequest Bounces(double sigma_before, double sigma_after) {
  return {.scene = {.system = Contact(), .restitution = NewtonCoefficient{0.5}},
          .unknowns = {{.path = "restitution.newton"}},
          .inputs = {{kBefore, kSpeeds, {sigma_before}}},
          .measured = {{kAfter, kReturned, {sigma_after}}}};
}

double SumOfBounces(double e, double sigma_before, double sigma_after) {
  double sum = 0.0;
  for (size_t row = 0; row < kSpeeds.size(); ++row) {
    const double residual = kReturned[row] + e * kSpeeds[row];
    sum += residual * residual / (sigma_after * sigma_after + e * e * sigma_before * sigma_before);
  }
  return sum;
}

// Deming's slope of a line through the origin.
double DemingSlope(double sigma_before, double sigma_after) {
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (size_t row = 0; row < kSpeeds.size(); ++row) {
    xx += kSpeeds[row] * kSpeeds[row];
    xy += kSpeeds[row] * kReturned[row];
    yy += kReturned[row] * kReturned[row];
  }
  const double ratio = sigma_after * sigma_after / (sigma_before * sigma_before);
  const double half = 0.5 * (yy - ratio * xx);
  return (half + std::sqrt(half * half + ratio * xy * xy)) / xy;
}

double Bisected(double low, double high, const std::function<bool(double)>& is_low) {
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (is_low(middle) ? low : high) = middle;
  }
  return low;
}

TEST(UncertainInputsTest, ALineThroughTheOriginHasDemingsSlopeAndItsInterval) {
  for (const auto& [before, after] : {std::pair(0.1, 0.1), std::pair(0.2, 0.05), std::pair(0.02, 0.3)}) {
    const absl::StatusOr<FitResponse> response = Fit(Bounces(before, after), Never);
    ASSERT_TRUE(response.ok()) << response.status();
    const FitEstimate& e = response->unknowns[0];
    const double slope = -DemingSlope(before, after);
    const double least = SumOfBounces(slope, before, after);
    EXPECT_NEAR(e.value, slope, 1e-6 * *e.sigma);
    EXPECT_NEAR(response->chi2, least, 1e-9 * least);
    const auto is_inside = [&, before = before, after = after](double at) {
      return SumOfBounces(at, before, after) < least + kFitRiseOfInterval;
    };
    EXPECT_NEAR(*e.high.value, Bisected(slope, 1.0, is_inside), 1e-4 * *e.sigma);
    EXPECT_NEAR(*e.low.value, Bisected(slope, 0.0, is_inside), 1e-4 * *e.sigma);
    EXPECT_NEAR(response->rows[0].residuals[0], (kReturned[0] + slope * kSpeeds[0]) / std::hypot(after, slope * before),
                1e-6);
  }
}

TEST(UncertainInputsTest, AnErrorBeforeMovesBothVelocitiesAfterTogether) {
  const double before = 0.1, along = 0.05, off = 0.08;
  FitRequest request = Bounces(before, off);
  request.scene.friction.kinetic_coefficient = 0.2;
  request.unknowns.push_back({.path = "friction.kinetic_coefficient"});
  request.measured.push_back({kSlipAfter, {3.75, 3.55, 3.05, 2.75, 1.85, 1.35}, {along}});
  const absl::StatusOr<FitResponse> response = Fit(request, Never);
  ASSERT_TRUE(response.ok()) << response.status();
  // u = 5 + 3 mu (1 + e) x and v = -e x, x < 0: the contact slides on, without w_tn.
  const auto sum = [&](double e, double mu) {
    const double slope = 3.0 * mu * (1.0 + e);
    const double uu = along * along + slope * slope * before * before, vv = off * off + e * e * before * before;
    const double uv = -slope * e * before * before;
    double squares = 0.0;
    for (size_t row = 0; row < kSpeeds.size(); ++row) {
      const double u = request.measured[1].values[row] - 5.0 - slope * kSpeeds[row];
      const double v = kReturned[row] + e * kSpeeds[row];
      squares += (vv * u * u - 2.0 * uv * u * v + uu * v * v) / (uu * vv - uv * uv);
    }
    return squares;
  };
  const double e = response->unknowns[0].value, mu = response->unknowns[1].value;
  EXPECT_NEAR(response->chi2, sum(e, mu), 1e-9 * response->chi2);
  EXPECT_EQ(response->objective, response->chi2);
  for (const double step : {-1e-4, 1e-4}) {
    EXPECT_GT(sum(e + step, mu), sum(e, mu));
    EXPECT_GT(sum(e, mu + step), sum(e, mu));
  }
  const double curvature = (sum(e + 1e-4, mu) - 2.0 * sum(e, mu) + sum(e - 1e-4, mu)) / 1e-8;
  EXPECT_GT(curvature, 0.0);
  EXPECT_NEAR(*response->unknowns[0].sigma, std::sqrt(2.0 / curvature), 0.1 * *response->unknowns[0].sigma);
}

// The rate after depends on the place of the contact by no line.
TEST(UncertainInputsTest, AnInputWithACurvedEffectIsFound) {
  const Case given = PendulumCase();
  FitRequest request = Noiseless(given);
  const double sigma = 0.05;
  request.inputs[1].sigma = {sigma};
  for (size_t row = 0; row < 4; ++row) request.measured[0].values[row] += row % 2 == 0 ? 0.03 : -0.04;
  const absl::StatusOr<FitResponse> response = Fit(request, Never);
  ASSERT_TRUE(response.ok()) << response.status();
  Scene scene = given.truth;
  scene.friction.kinetic_coefficient = response->unknowns[0].value;
  scene.restitution = EnergeticCoefficient{response->unknowns[1].value};
  double least = 0.0;
  const LocalSolver solver;
  for (size_t row = 0; row < 4; ++row) {
    const double stated = request.inputs[1].values[row];
    const auto sum = [&](double a) {
      scene.system =
          Pendulum{.inertia_kg_m2 = 0.2, .a_m = a, .b_m = 1.0, .omega_minus_rad_s = request.inputs[0].values[row]};
      const Outcome outcome = solver.Solve({.scene = scene})->outcome;
      const double rate = (request.measured[0].values[row] - outcome.rates_after_rad_s[0]) / 0.01;
      const double impulse = (request.measured[1].values[row] - outcome.impulse.normal_total_n_s) / 0.002;
      const double shift = (a - stated) / sigma;
      return rate * rate + impulse * impulse + shift * shift;
    };
    double low = stated - 3.0 * sigma, high = stated + 3.0 * sigma;
    for (int i = 0; i < 200; ++i) {
      const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
      (sum(a) < sum(b) ? high : low) = sum(a) < sum(b) ? b : a;
    }
    least += sum(0.5 * (low + high));
  }
  EXPECT_NEAR(response->chi2, least, 1e-6 * least);
}

// At the speed where slip just stops the prediction has a corner, on which the best inputs may lie.
TEST(UncertainInputsTest, ACornerOfThePredictionEndsTheSearchNearTheBestInputs) {
  FitRequest request = {
      .scene = {.system =
                    PlanarContact{.w_tt_per_kg = 3.0, .w_nn_per_kg = 1.0, .tangential_m_s = 1.0, .normal_m_s = -1.0},
                .friction = {.kinetic_coefficient = 0.25},
                .restitution = NewtonCoefficient{0.5}},
      .unknowns = {{.path = "friction.kinetic_coefficient"}},
      .inputs = {{"planar_contact.tangential_m_s", {3.0, 1.0}, {0.0, 0.2}}},
      .measured = {{kSlipAfter, {1.875, -0.05}, {0.01, 0.1}}}};
  const absl::StatusOr<FitResponse> response = Fit(request, Never);
  ASSERT_TRUE(response.ok()) << response.status();
  const double mu = response->unknowns[0].value;
  const auto sum = [mu](double u) {
    const double after = std::max(0.0, u - 3.0 * mu * 1.5);
    return std::pow((-0.05 - after) / 0.1, 2) + std::pow((u - 1.0) / 0.2, 2);
  };
  double least = sum(1.0);
  for (double u = 0.0; u < 2.0; u += 1e-4) least = std::min(least, sum(u));
  const double first = (1.875 - (3.0 - 3.0 * mu * 1.5)) / 0.01;
  EXPECT_NEAR(response->chi2, first * first + least, 1e-3 * least);
}

// The exact number on the way of the uncertain one tells the input, whatever that was measured as.
TEST(UncertainInputsTest, AnExactNumberBesideAnUncertainInputTellsTheInput) {
  FitRequest request = Bounces(1e3, 0.1);
  request.measured.push_back({"impulse.normal_total_n_s", {}, {1e-6}});
  for (const double speed : kSpeeds) request.measured[1].values.push_back(-1.6 * speed);
  const absl::StatusOr<FitResponse> response = Fit(request, Never);
  ASSERT_TRUE(response.ok()) << response.status();
  // p = (1 + e) |x| and y = e |x|, so that y/p = e/(1 + e) where x is as good as unknown.
  double py = 0.0, pp = 0.0;
  for (size_t row = 0; row < kSpeeds.size(); ++row) {
    const double p = request.measured[1].values[row];
    py += p * kReturned[row];
    pp += p * p;
  }
  const double ratio = py / pp;
  EXPECT_NEAR(response->unknowns[0].value, ratio / (1.0 - ratio), 1e-6);
}

TEST(UncertainInputsTest, ASigmaOfZeroIsNone) {
  FitRequest with = Bounces(0.0, 0.1), without = with;
  without.inputs[0].sigma.clear();
  const absl::StatusOr<FitResponse> a = Fit(with, Never), b = Fit(without, Never);
  ASSERT_TRUE(a.ok() && b.ok()) << a.status() << b.status();
  EXPECT_TRUE(*a == *b);
}

TEST(UncertainInputsTest, AnOutlierIsNamedByTheErrorThatInputsExplain) {
  FitRequest request = Bounces(0.2, 0.01);
  const absl::StatusOr<FitResponse> response = Fit(request, Never);
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_TRUE(response->outliers.empty());
  request.inputs[0].sigma.clear();
  const absl::StatusOr<FitResponse> exact = Fit(request, Never);
  ASSERT_TRUE(exact.ok()) << exact.status();
  EXPECT_FALSE(exact->outliers.empty());
  EXPECT_TRUE(exact->refused);
}

TEST(UncertainInputsTest, AnEnergyGainThatAnInputExplainsRefusesNothing) {
  FitRequest request = {.scene = {.system = Contact(), .restitution = EnergeticCoefficient{0.9}},
                        .unknowns = {{.path = "restitution.energetic"}},
                        .inputs = {{kBefore, {-1.0, -1.0, -1.0}, {0.2}}},
                        .measured = {{kSlipAfter, {5.0, 5.0, 5.0}, {0.01}}, {kAfter, {0.9, 1.2, 0.8}, {0.01}}}};
  const absl::StatusOr<FitResponse> response = Fit(request, Never);
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_TRUE(response->rows[1].broken_limits.empty());
  EXPECT_FALSE(response->refused);
  request.inputs[0].sigma.clear();
  const absl::StatusOr<FitResponse> exact = Fit(request, Never);
  ASSERT_TRUE(exact.ok()) << exact.status();
  EXPECT_FALSE(exact->rows[1].broken_limits.empty());
}

}  // namespace
}  // namespace ricochet::fit
