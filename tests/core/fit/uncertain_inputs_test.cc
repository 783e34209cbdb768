// Fits whose inputs have errors, against sums of squares that are written out here.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <variant>
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

// The slip after is max(u - 4.5 mu, 0): behind the threshold the second row fits as well as before it.
TEST(UncertainInputsTest, AnIntervalGoesOnBehindAThresholdOfTheInputs) {
  const std::vector<double> stated = {3.0, 1.1, 2.5, 4.0}, measured = {1.895, 0.1, 1.325, 2.905};
  const double before = 0.1, after = 0.01;
  const FitRequest request = {
      .scene = {.system =
                    PlanarContact{.w_tt_per_kg = 3.0, .w_nn_per_kg = 1.0, .tangential_m_s = 1.0, .normal_m_s = -1.0},
                .friction = {.kinetic_coefficient = 0.25},
                .restitution = NewtonCoefficient{0.5}},
      .unknowns = {{.path = "friction.kinetic_coefficient"}},
      .inputs = {{"planar_contact.tangential_m_s", stated, {before}}},
      .measured = {{kSlipAfter, measured, {after}}}};
  const auto sum = [&](double mu) {
    double squares = 0.0;
    for (size_t row = 0; row < stated.size(); ++row) {
      const double edge = 4.5 * mu;
      const auto at = [&](double u) {
        return std::pow((measured[row] - std::max(u - edge, 0.0)) / after, 2) + std::pow((u - stated[row]) / before, 2);
      };
      const double slips =
          (stated[row] * after * after + (measured[row] + edge) * before * before) / (after * after + before * before);
      squares += std::min(at(std::min(stated[row], edge)), at(std::max(slips, edge)));
    }
    return squares;
  };
  const absl::StatusOr<FitResponse> response = Fit(request, Never);
  ASSERT_TRUE(response.ok()) << response.status();
  const FitEstimate& mu = response->unknowns[0];
  EXPECT_NEAR(response->chi2, sum(mu.value), 1e-6 * response->chi2);
  const auto is_inside = [&](double at) { return sum(at) < response->chi2 + kFitRiseOfInterval; };
  EXPECT_NEAR(*mu.high.value, Bisected(mu.value, 0.4, is_inside), 1e-5);
  EXPECT_NEAR(*mu.low.value, Bisected(mu.value, 0.0, is_inside), 1e-5);
}

TEST(UncertainInputsTest, AContactThatMayApproachIsNotRefused) {
  FitRequest request = {.scene = {.system = Contact(), .restitution = NewtonCoefficient{0.5}},
                        .unknowns = {{.path = "restitution.newton"}},
                        .inputs = {{kBefore, {0.02, -1.0, -2.0}, {0.05}}},
                        .measured = {{kAfter, {0.01, 0.52, 0.98}, {0.005}}}};
  const absl::StatusOr<FitResponse> response = Fit(request, Never);
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_FALSE(response->refused);
  const double e = response->unknowns[0].value;
  // The first contact parts as it came, as that costs less than to strike.
  double squares = 0.01 * 0.01 / (0.05 * 0.05 + 0.005 * 0.005);
  for (size_t row = 1; row < 3; ++row) {
    const double residual = request.measured[0].values[row] + e * request.inputs[0].values[row];
    squares += residual * residual / (0.005 * 0.005 + e * e * 0.05 * 0.05);
  }
  EXPECT_NEAR(response->chi2, squares, 1e-6 * squares);
}

TEST(UncertainInputsTest, AContactStatedToPartIsFittedAsOneThatStrikes) {
  const FitRequest request = {.scene = {.system = Contact(), .restitution = NewtonCoefficient{0.5}},
                              .unknowns = {{.path = "restitution.newton"}},
                              .inputs = {{kBefore, {0.02, -1.0, -2.0}, {0.05}}},
                              .measured = {{"coefficients.newton", {0.5, 0.52, 0.49}, {0.02}}}};
  const absl::StatusOr<FitResponse> response = Fit(request, Never);
  ASSERT_TRUE(response.ok()) << response.status();
  const double mean = (0.5 + 0.52 + 0.49) / 3.0;
  EXPECT_NEAR(response->unknowns[0].value, mean, 1e-6);
  // The coefficient does not depend on the speed, as long as there is one.
  const double squares =
      std::pow(0.02 / 0.05, 2) +
      (std::pow(0.5 - mean, 2) + std::pow(0.52 - mean, 2) + std::pow(0.49 - mean, 2)) / (0.02 * 0.02);
  EXPECT_NEAR(response->chi2, squares, 0.05);
  EXPECT_NE(response->rows[0].regime, Regime::kSeparating);
  EXPECT_FALSE(response->refused);
}

TEST(UncertainInputsTest, ARobustFitDoesNotDependOnTheOrderOfTheNumbers) {
  FitRequest request = Bounces(0.1, 0.08);
  request.scene.friction.kinetic_coefficient = 0.2;
  request.measured.push_back({kSlipAfter, {3.75, 3.55, 3.05, 2.75, 2.85, 1.35}, {0.05}});
  for (const FitLoss loss : {FitLoss::kHuber, FitLoss::kCauchy}) {
    request.loss = loss;
    const absl::StatusOr<FitResponse> one = Fit(request, Never);
    std::swap(request.measured[0], request.measured[1]);
    const absl::StatusOr<FitResponse> other = Fit(request, Never);
    ASSERT_TRUE(one.ok() && other.ok()) << one.status() << other.status();
    EXPECT_NEAR(one->unknowns[0].value, other->unknowns[0].value, 1e-6);
    EXPECT_NEAR(*one->unknowns[0].sigma, *other->unknowns[0].sigma, 1e-6);
    EXPECT_NEAR(one->objective, other->objective, 1e-6 * one->objective);
  }
}

TEST(UncertainInputsTest, ASmallSigmaBesideThatOfAnInputKeepsItsDegreesOfFreedom) {
  for (const double ratio : {1e-7, 1e-9, 1e-12}) {
    const double before = 0.1, after = 0.1 * ratio;
    const absl::StatusOr<FitResponse> response = Fit(Bounces(before, after), Never);
    ASSERT_TRUE(response.ok()) << response.status();
    EXPECT_EQ(response->degrees_of_freedom, 5);
    const double slope = -DemingSlope(before, after);
    EXPECT_NEAR(response->unknowns[0].value, slope, 1e-4 * *response->unknowns[0].sigma) << ratio;
    EXPECT_NEAR(response->chi2, SumOfBounces(slope, before, after), 1e-6 * response->chi2) << ratio;
  }
}

TEST(UncertainInputsTest, AnErrorThatAllRowsShareHasANote) {
  FitRequest request = Bounces(0.1, 0.1);
  request.inputs.push_back({"planar_contact.w_nn_per_kg", {1.0}, {0.1}});
  const absl::StatusOr<FitResponse> response = Fit(request, Never);
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_THAT(response->notes,
              testing::Contains(testing::HasSubstr("planar_contact.w_nn_per_kg count as independent from row to row")));
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
  for (int i = 0; i < 20'000; ++i) least = std::min(least, sum(1e-4 * i));
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

// v+ = -e (v - s) with an uncertain e <= 1 for each row: its square is least over e, which is 1 where more would be.
double SumOverRestitutions(double s, const std::vector<double>& e, const std::vector<double>& before,
                           const std::vector<double>& after) {
  constexpr double kSigmaOfE = 0.05, kSigma = 0.01;
  double sum = 0.0;
  for (size_t row = 0; row < e.size(); ++row) {
    const double approach = (before[row] - s) / kSigma, seen = after[row] / kSigma;
    const double weight = 1.0 / (kSigmaOfE * kSigmaOfE);
    const double best = std::min(1.0, (e[row] * weight - approach * seen) / (weight + approach * approach));
    sum += std::pow(seen + best * approach, 2.0) + std::pow((e[row] - best) / kSigmaOfE, 2.0);
  }
  return sum;
}

TEST(UncertainInputsTest, AnInputAtTheEndOfItsRuleStaysThere) {
  const std::vector<double> e = {0.99, 0.98, 1.0}, before = {-1.0, -2.0, -3.0}, after = {1.1, 2.2, 3.25};
  const FitRequest request = {.scene = {.system = Contact(), .restitution = EnergeticCoefficient{0.6}},
                              .unknowns = {{.path = "surface_velocity.normal_m_s", .start = 0.0}},
                              .inputs = {{"restitution.energetic", e, {0.05}}, {kBefore, before}},
                              .measured = {{kAfter, after, {0.01}}}};
  const absl::StatusOr<FitResponse> response = Fit(request, Never);
  ASSERT_TRUE(response.ok()) << response.status();
  const auto sum = [&](double s) { return SumOverRestitutions(s, e, before, after); };
  constexpr double kStep = 1e-5;
  const double best = Bisected(0.2, 0.3, [&](double s) { return sum(s + kStep) < sum(s - kStep); });
  const double curvature = (sum(best + kStep) - 2.0 * sum(best) + sum(best - kStep)) / (kStep * kStep);
  const FitEstimate& speed = response->unknowns[0];
  EXPECT_NEAR(speed.value, best, 1e-3 * std::sqrt(2.0 / curvature));
  EXPECT_NEAR(*speed.sigma, std::sqrt(2.0 / curvature), 0.01 * *speed.sigma);
  EXPECT_NEAR(response->chi2, sum(best), 1e-6 * sum(best));
  EXPECT_EQ(response->degrees_of_freedom, 3);  // Three numbers, an unknown, and an input that is held.
  EXPECT_GT(speed.row_shares[2], 0.9);
  const double rise = sum(best) + kFitRiseOfInterval;
  EXPECT_NEAR(*speed.low.value, Bisected(0.0, best, [&](double s) { return sum(s) > rise; }), 1e-3 * *speed.sigma);
  EXPECT_NEAR(*speed.high.value, Bisected(best, 0.5, [&](double s) { return sum(s) < rise; }), 1e-3 * *speed.sigma);
}

// Friction only slows the slip of 2 m/s, so that the inputs that fit best are 0. The search finds that end beyond the
// threshold of sticking, too.
TEST(UncertainInputsTest, AnInputWithoutAnyEffectLeftTellsNothingOfOthers) {
  FitRequest request = {.scene = {.system = Contact(), .restitution = NewtonCoefficient{0.6}},
                        .unknowns = {{.path = "restitution.newton"}},
                        .inputs = {{"friction.kinetic_coefficient", {0.01, 0.02, 0.0}, {0.05}}},
                        .measured = {{kSlipAfter, {2.1, 2.12, 2.05}, {0.02}}}};
  std::get<PlanarContact>(request.scene.system).tangential_m_s = 2.0;
  const absl::StatusOr<FitResponse> response = Fit(request, Never);
  ASSERT_TRUE(response.ok()) << response.status();
  EXPECT_NEAR(response->chi2, 5 * 5 + 6 * 6 + 2.5 * 2.5 + 0.2 * 0.2 + 0.4 * 0.4, 1e-6);
  EXPECT_EQ(response->degrees_of_freedom, 6);
  EXPECT_EQ(response->outliers.size(), 3U);
  EXPECT_NEAR(response->rows[1].residuals[0], 6.0, 1e-6);
  const FitEstimate& newton = response->unknowns[0];
  EXPECT_FALSE(newton.seen);
  EXPECT_EQ(newton.low.kind, FitEndKind::kNotSeen);
  EXPECT_EQ(newton.high.kind, FitEndKind::kNotSeen);
}

// Errors of 0.1 of the approach let e seem to be above 1; the interval says so, and no single row proves more.
TEST(UncertainInputsTest, TheAuditOfARowAllowsForTheErrorsOfItsInputs) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  int refused = 0;
  for (int set = 0; set < 100; ++set) {
    std::vector<double> before, after, slips;
    for (int row = 0; row < 5; ++row) {
      const double approach = -std::uniform_real_distribution<double>(0.8, 1.2)(random);
      before.push_back(approach + 0.1 * normal(random));
      after.push_back(-0.95 * approach + 0.005 * normal(random));
      slips.push_back(5.0 + 0.005 * normal(random));
    }
    const absl::StatusOr<FitResponse> response =
        Fit({.scene = {.system = Contact(), .restitution = NewtonCoefficient{0.6}},
             .unknowns = {{.path = "restitution.newton"}},
             .inputs = {{kBefore, before, {0.1}}},
             .measured = {{kSlipAfter, slips, {0.005}}, {kAfter, after, {0.005}}}},
            Never);
    ASSERT_TRUE(response.ok()) << response.status();
    refused += response->refused ? 1 : 0;
  }
  EXPECT_LE(refused, 1);  // One in a thousand is refused by chance.
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
