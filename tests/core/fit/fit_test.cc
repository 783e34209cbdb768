// Fits of impacts whose truth is known, and what a fit says of data that tell nothing.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/engine/parallel_batch.h"
#include "core/fit/information.h"
#include "core/fit/judgement.h"
#include "ricochet/solver.h"
#include "tests/core/fit/fit_cases.h"

namespace ricochet::fit {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

bool Never() { return false; }

bool HasNote(const FitResponse& response, const std::string& text) {
  for (const std::string& note : response.notes) {
    if (note.find(text) != std::string::npos) return true;
  }
  return false;
}

class Recovery : public testing::TestWithParam<Case> {};

TEST_P(Recovery, NoiselessDataGiveTheTruth) {
  const absl::StatusOr<FitResponse> response = Fit(Noiseless(GetParam()), Never);
  ASSERT_TRUE(response.ok()) << response.status();
  for (size_t k = 0; k < GetParam().true_values.size(); ++k) {
    const FitEstimate& estimate = response->unknowns[k];
    const double truth = GetParam().true_values[k];
    EXPECT_NEAR(estimate.value, truth, 1e-8 * truth) << estimate.path;
    EXPECT_TRUE(estimate.seen) << estimate.path;
    EXPECT_EQ(estimate.low.kind, FitEndKind::kFound) << estimate.path;
    EXPECT_LT(*estimate.low.value, truth);
    EXPECT_GT(estimate.high.value.value_or(2.0 * truth), truth);
  }
  EXPECT_TRUE(response->starts.front().converged);
  EXPECT_FALSE(response->refused);
  EXPECT_THAT(response->outliers, IsEmpty());
  EXPECT_LT(response->chi2, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Systems, Recovery,
                         testing::Values(PendulumCase(), ContactCase(), BodyCase(), SpaceCase(), CompliantCase()),
                         [](const auto& given) { return given.param.name; });

TEST(FitTest, SaysWhichDerivativesItUsed) {
  EXPECT_TRUE(Fit(Noiseless(ContactCase()), Never)->exact_derivatives);
  const FitResponse space = *Fit(Noiseless(SpaceCase()), Never);
  EXPECT_FALSE(space.exact_derivatives);
  EXPECT_THAT(space.why_differences, HasSubstr("impact in space"));
  EXPECT_TRUE(HasNote(space, "central differences"));
}

// All rows stick, so that any larger friction gives the same numbers.
TEST(FitTest, FrictionOfRowsThatStickHasNoFiniteInterval) {
  Case sticking = ContactCase();
  sticking.truth.friction.kinetic_coefficient = 2.0;
  sticking.unknowns[0].start = 3.0;
  sticking.inputs[0].values = {0.1, 0.15, 0.2, 0.1, 0.2, 0.1};
  for (const bool bounded : {false, true}) {
    if (bounded) sticking.unknowns[0].high = 5.0;
    const FitResponse response = *Fit(Noiseless(sticking), Never);
    const FitEstimate& friction = response.unknowns[0];
    EXPECT_FALSE(friction.seen);
    EXPECT_FALSE(friction.sigma.has_value());
    EXPECT_EQ(friction.high.kind, FitEndKind::kNotSeen);
    EXPECT_FALSE(friction.high.value.has_value());
    EXPECT_THAT(friction.row_shares, IsEmpty());
    EXPECT_TRUE(std::isnan(response.covariance[0]));
    EXPECT_TRUE(HasNote(response, "friction.kinetic_coefficient is not seen in these data: all rows stick"));
    EXPECT_TRUE(response.unknowns[1].seen);
    EXPECT_EQ(response.unknowns[1].low.kind, FitEndKind::kFound);
  }
}

// Static friction is at least kinetic friction, which the data do tell.
TEST(FitTest, AnUnknownThatNoNumberDependsOnEndsWhereARuleTiesItToAnother) {
  Case given = ContactCase();
  given.unknowns.push_back({.path = "friction.static_coefficient", .start = 0.5});
  given.truth.friction.kinetic_coefficient = 0.05;
  given.truth.friction.static_coefficient = 0.5;
  given.unknowns[0].start = 0.06;
  given.inputs[0].values = {3.0, 3.5, 4.0, 5.0, 6.0, 7.0};
  const FitResponse response = *Fit(Noiseless(given), Never);
  EXPECT_FALSE(response.unknowns[2].seen);
  EXPECT_EQ(response.unknowns[2].high.kind, FitEndKind::kNotSeen);
  EXPECT_FALSE(response.unknowns[2].high.value.has_value());
  ASSERT_EQ(response.unknowns[2].low.kind, FitEndKind::kFound);
  EXPECT_NEAR(*response.unknowns[2].low.value, *response.unknowns[0].low.value, 1e-5);
}

// Rows that slide tell the product mu (1 + e) alone where only the tangential velocity is measured and W is diagonal.
TEST(FitTest, AProductIsNotSeenByItsFactors) {
  Case given = ContactCase();
  std::get<PlanarContact>(given.truth.system).w_tn_per_kg = 0.0;
  given.inputs[0].values = {3.0, 4.0, 5.0, 6.0, 7.0, 8.0};
  given.measured.pop_back();
  const FitResponse response = *Fit(Noiseless(given), Never);
  EXPECT_FALSE(response.unknowns[0].seen);
  EXPECT_FALSE(response.unknowns[1].seen);
  EXPECT_EQ(response.degrees_of_freedom, 5);
  EXPECT_TRUE(HasNote(response, "only a combination with other unknowns"));
}

// Rows that slide tell the ratio (W_tn - mu W_tt) / (W_nn - mu W_tn) and the coefficient, two combinations of three
// unknowns: for each W_tn below sqrt(W_tt W_nn) there is a friction that fits as well.
TEST(FitTest, AProfileFollowsItsValleyToTheEnd) {
  const double e = 0.6, w_tt = 2.5, ratio = (0.4 - 0.25 * 3.0) / (1.0 - 0.25 * 0.4);
  FitRequest request = {.scene = {.system = PlanarContact{.w_tt_per_kg = w_tt, .w_tn_per_kg = 0.3, .w_nn_per_kg = 1.0},
                                  .friction = {.kinetic_coefficient = 0.2},
                                  .restitution = PoissonCoefficient{0.5}},
                        .unknowns = {{.path = "friction.kinetic_coefficient", .start = 0.2},
                                     {.path = "planar_contact.w_tn_per_kg", .start = 0.3},
                                     {.path = "restitution.poisson", .start = 0.5}},
                        .inputs = {{"planar_contact.tangential_m_s", {}}, {"planar_contact.normal_m_s", {}}},
                        .measured = {{"contact_velocity_after.tangential_m_s[0]", {}, {0.02}},
                                     {"contact_velocity_after.normal_m_s", {}, {0.02}}}};
  for (int row = 0; row < 10; ++row) {
    const double u = 1.5 + 2.5 * row / 9.0, v = -2.0 + 1.5 * row / 9.0;
    request.inputs[0].values.push_back(u);
    request.inputs[1].values.push_back(v);
    request.measured[0].values.push_back(u - ratio * (1.0 + e) * v);
    request.measured[1].values.push_back(-e * v);
  }
  const FitResponse response = *Fit(request, Never);
  const FitEstimate& w_tn = response.unknowns[1];
  EXPECT_FALSE(w_tn.seen);
  EXPECT_EQ(w_tn.high.kind, FitEndKind::kNotSeen);
  EXPECT_GT(w_tn.profile.back().value, 0.999 * std::sqrt(w_tt));
  for (const FitProfilePoint& point : w_tn.profile) {
    EXPECT_TRUE(point.value < 0.0 || point.rise < 1e-5) << point.value << " rises by " << point.rise;
  }
}

TEST(FitTest, NamesAnOutlierAndRefusesTheData) {
  FitRequest request = Noiseless(ContactCase());
  request.measured[1].values[3] += 0.2;
  const FitResponse squares = *Fit(request, Never);
  ASSERT_FALSE(squares.outliers.empty());
  EXPECT_EQ(squares.outliers[0].row, 3);
  EXPECT_TRUE(squares.refused);
  EXPECT_TRUE(HasNote(squares, "refuse the physics"));
  request.loss = FitLoss::kCauchy;
  const FitResponse robust = *Fit(request, Never);
  ASSERT_EQ(robust.outliers.size(), 1);
  EXPECT_NEAR(robust.unknowns[1].value, 0.6, 0.003);
  EXPECT_GT(std::fabs(squares.unknowns[1].value - 0.6), 0.01);
  request.loss = FitLoss::kHuber;
  EXPECT_NEAR(Fit(request, Never)->unknowns[1].value, 0.6, 0.01);
}

TEST(FitTest, ARowThatBreaksALimitRefusesThePhysics) {
  FitRequest request = Noiseless(ContactCase());
  request.measured[1].values[2] = 1.9;  // It rebounds faster than it came.
  const FitResponse response = *Fit(request, Never);
  EXPECT_FALSE(response.rows[2].broken_limits.empty());
  EXPECT_TRUE(response.refused);
  EXPECT_TRUE(HasNote(response, "Row 2 breaks"));
}

TEST(FitTest, ARateOfAPendulumIsAuditedToo) {
  FitRequest request = Noiseless(PendulumCase());
  request.measured[0].values[1] = 2.5;
  EXPECT_TRUE(HasNote(*Fit(request, Never), "Row 1 breaks"));
}

// The first search ends in the wrong valley, beyond the centre; its profile finds the other.
TEST(FitTest, AProfileThatFindsABetterFitStartsAgainFromThere) {
  FitRequest request = {
      .scene = {.system =
                    PlanarBody{.mass_kg = 0.5, .inertia_com_kg_m2 = 0.01, .offset_t_m = 0.1, .velocity_n_m_s = -2.0},
                .restitution = NewtonCoefficient{0.5}},
      .unknowns = {{.path = "planar_body.offset_t_m", .start = 0.05, .low = -0.3, .high = 0.3}},
      .measured = {{"bodies_after[0].linear_m_s[1]", {0.0}, {1.0}},
                   {"bodies_after[0].angular_rad_s[0]", {0.0}, {20.0}}}};
  // The spin of the true side, with a large error, makes its valley a little deeper.
  const Outcome truth = LocalSolver().Solve({.scene = request.scene})->outcome;
  request.measured[0].values = {truth.bodies_after[0].linear_m_s[1]};
  request.measured[1].values = {-truth.bodies_after[0].angular_rad_s[0]};
  const FitResponse response = *Fit(request, Never);
  EXPECT_LT(response.unknowns[0].value, 0.0);
  EXPECT_GT(response.starts[0].objective, response.objective);
}

TEST(FitTest, AnIntervalIsCutByItsBound) {
  FitRequest request = Noiseless(ContactCase());
  request.unknowns[1].low = 0.5999;
  const FitResponse response = *Fit(request, Never);
  EXPECT_EQ(response.unknowns[1].low.kind, FitEndKind::kCutByBound);
  EXPECT_EQ(response.unknowns[1].low.value, 0.5999);
  EXPECT_TRUE(HasNote(response, "lower end of the interval of restitution.poisson is cut by a bound"));
}

TEST(FitTest, NumbersThatWereNotMeasuredAreLeftOut) {
  FitRequest request = Noiseless(ContactCase());
  request.measured[0].values[1] = std::nan("");
  const FitResponse response = *Fit(request, Never);
  EXPECT_EQ(response.degrees_of_freedom, 9);
  EXPECT_TRUE(std::isnan(response.rows[1].residuals[0]));
  EXPECT_TRUE(std::isnan(response.rows[1].predicted[0]));
  EXPECT_FALSE(std::isnan(response.rows[1].residuals[1]));
}

// Slip that only just stops: the velocity after has a corner at the true friction.
TEST(FitTest, SaysThatTheBestFitLiesOnAThreshold) {
  FitRequest request = {.scene = ContactCase().truth,
                        .unknowns = {{.path = "friction.kinetic_coefficient", .start = 0.3, .low = 0.0, .high = 0.5}},
                        .inputs = {{"planar_contact.tangential_m_s", {2.0}}},
                        .measured = {{"contact_velocity_after.tangential_m_s[0]", {0.0}, {0.01}}}};
  auto& contact = std::get<PlanarContact>(request.scene.system);
  contact.w_tn_per_kg = 0.0;
  const FitResponse response = *Fit(request, Never);
  // mu w_tt (1 + e) |v|/w_nn = u: slip stops as the impact ends.
  EXPECT_NEAR(response.unknowns[0].value, 2.0 / (3.0 * 1.6), 1e-6);
  ASSERT_EQ(response.thresholds.size(), 1);
  EXPECT_EQ(response.thresholds[0].by, "friction.kinetic_coefficient");
  EXPECT_NEAR(response.thresholds[0].from_below, -4.8, 1e-3);
  EXPECT_NEAR(response.thresholds[0].from_above, 0.0, 1e-3);
  EXPECT_TRUE(HasNote(response, "The best fit lies on a threshold"));
}

TEST(FitTest, FurtherStartsSpreadOverTheBounds) {
  FitRequest request = Noiseless(ContactCase());
  request.unknowns[0].high = 1.0;
  request.unknowns[1].high = 1.0;
  request.starts = 8;
  const FitResponse response = *Fit(request, Never);
  ASSERT_EQ(response.starts.size(), 8);
  for (const FitStart& start : response.starts) {
    for (size_t k = 0; k < 2; ++k) EXPECT_TRUE(start.from[k] >= 0.0 && start.from[k] <= 1.0);
  }
  EXPECT_NE(response.starts[1].from, response.starts[2].from);
  EXPECT_NEAR(response.unknowns[0].value, 0.25, 1e-8);
}

// At the start all rows stick, so that no number changes with friction; the data are those of rows that slip.
TEST(FitTest, DataAreNotRefusedBeforeFurtherStarts) {
  Case given = ContactCase();
  given.unknowns[0].start = 5.0;
  FitRequest request = Noiseless(given);
  const FitResponse response = *Fit(request, Never);
  EXPECT_GT(response.starts.size(), 1);
  EXPECT_FALSE(response.refused);
  EXPECT_TRUE(response.unknowns[0].seen);
  EXPECT_NEAR(response.unknowns[0].value, given.truth.friction.kinetic_coefficient, 1e-8);
}

TEST(FitTest, WhatIsSeenDoesNotDependOnTheSizeOfTheStart) {
  Case given = ContactCase();
  given.unknowns[0].start = 1e-9;
  const FitResponse response = *Fit(Noiseless(given), Never);
  EXPECT_NEAR(response.unknowns[0].value, given.truth.friction.kinetic_coefficient, 1e-8);
  EXPECT_TRUE(response.unknowns[0].seen);
  EXPECT_TRUE(response.unknowns[0].sigma.has_value());
}

// Without friction the rebound is the same for a centre of mass on either side.
TEST(FitTest, SaysThatStartsEndedInDifferentPlaces) {
  Case given = BodyCase();
  given.truth.friction.kinetic_coefficient = 0.0;
  given.unknowns = {{.path = "planar_body.offset_t_m", .start = 0.05, .low = -0.2, .high = 0.2}};
  given.truth.system = PlanarBody{.mass_kg = 0.5, .inertia_com_kg_m2 = 0.01, .offset_t_m = 0.1, .velocity_n_m_s = -2.0};
  given.inputs = {{"planar_body.velocity_n_m_s", {-1.0, -2.0}}};
  given.measured = {{"bodies_after[0].linear_m_s[1]", 0.01}};
  FitRequest request = Noiseless(given);
  request.starts = 6;
  const FitResponse response = *Fit(request, Never);
  EXPECT_NEAR(std::fabs(response.unknowns[0].value), 0.1, 1e-8);
  EXPECT_TRUE(response.starts_differ);
  EXPECT_TRUE(HasNote(response, "ended in different places"));
}

TEST(FitTest, TheRegionOfTwoSurroundsTheBestFit) {
  FitRequest request = Noiseless(ContactCase());
  request.region = {"friction.kinetic_coefficient", "restitution.poisson"};
  const FitResponse response = *Fit(request, Never);
  ASSERT_EQ(response.region.size(), 48);
  for (const FitRegionPoint& point : response.region) EXPECT_EQ(point.kind, FitEndKind::kFound);
  EXPECT_GT(response.region[0].x, *response.unknowns[0].high.value);  // Two degrees of freedom reach further than one.
}

// chi2 of a request with its unknowns at given values, from single solutions.
double ChiSquaredAt(const FitRequest& request, const std::vector<double>& at) {
  BatchSetup setup = {.scene = request.scene};
  std::vector<std::vector<double>> in, out;
  const size_t rows = request.measured.front().values.size();
  for (size_t k = 0; k < at.size(); ++k) {
    setup.fields.push_back(request.unknowns[k].path);
    in.emplace_back(rows, at[k]);
  }
  for (const FitInput& input : request.inputs) {
    setup.fields.push_back(input.path);
    in.push_back(input.values);
  }
  for (const FitMeasured& measured : request.measured) {
    setup.columns.push_back(measured.path);
    out.emplace_back(rows);
  }
  BatchRows batch = {.inputs = {in.begin(), in.end()}, .outputs = {out.begin(), out.end()}};
  EXPECT_TRUE(LocalSolver().SolveBatch(setup, batch).ok());
  double sum = 0.0;
  for (size_t c = 0; c < out.size(); ++c) {
    for (size_t row = 0; row < rows; ++row) {
      const double residual = (request.measured[c].values[row] - out[c][row]) / request.measured[c].sigma[0];
      sum += residual * residual;
    }
  }
  return sum;
}

// The more friction, the better do all rows that stick fit, and the less does any further friction change.
TEST(FitTest, AnEstimateThatRunsOffKeepsItsFiniteEnd) {
  FitRequest request = {.scene = {.system = PlanarContact{2.0, 0.2, 1.0}, .restitution = EnergeticCoefficient{0.5}},
                        .unknowns = {{.path = "friction.kinetic_coefficient", .start = 0.3}},
                        .inputs = {{"planar_contact.tangential_m_s", {1.0, -1.0, 0.5}},
                                   {"planar_contact.normal_m_s", {-1.5, -2.0, -1.0}}},
                        .measured = {{"contact_velocity_after.normal_m_s", {0.82, 0.95, 0.53}, {0.02}}}};
  const FitResponse response = *Fit(request, Never);
  const FitEnd& low = response.unknowns[0].low;
  ASSERT_EQ(low.kind, FitEndKind::kFound);
  EXPECT_NEAR(ChiSquaredAt(request, {*low.value}) - ChiSquaredAt(request, {1e9}), 3.841458820694124, 1e-3);
}

// The contact slides: u1 = u0 - mu (1 + e) |v0| Wtt, which tells mu to sigma / (Wtt (1 + e) |v0|) whatever the start.
TEST(FitTest, AStartFarFromTheFitChangesNoInterval) {
  for (const auto& [start, high] : {std::pair(1e-3, 1.0), {0.0, 100.0}, {500.0, 1e9}}) {
    const FitRequest request = {
        .scene = {.system = PlanarContact{2.0, 0.0, 1.0, 1.0, -1.0}, .restitution = NewtonCoefficient{1.0}},
        .unknowns = {{.path = "friction.kinetic_coefficient", .start = start, .high = high}},
        .measured = {{"contact_velocity_after.tangential_m_s[0]", {0.996 - 2e-6, 0.996 + 2e-6}, {4e-6}}}};
    const FitEstimate found = Fit(request, Never)->unknowns[0];
    const double sigma = 1e-6 / std::sqrt(2.0);
    EXPECT_NEAR(found.value, 1e-3, 1e-12) << start;
    EXPECT_NEAR(found.sigma.value_or(0.0), sigma, 1e-12) << start;
    ASSERT_EQ(found.low.kind, FitEndKind::kFound) << start;
    EXPECT_NEAR(*found.low.value, 1e-3 - std::sqrt(3.841458820694124) * sigma, 1e-10) << start;
    EXPECT_NEAR(found.high.value.value_or(0.0), 1e-3 + std::sqrt(3.841458820694124) * sigma, 1e-10) << start;
  }
}

// T = pi sqrt(m / k) for a contact that gives everything back, so that k = pi^2 m / T^2.
TEST(FitTest, AStiffnessIsFoundFromAnyStart) {
  const double right = std::numbers::pi * std::numbers::pi * 0.5 / 4e-6;
  for (const double start : {1.0, 1e6, 1e13}) {
    const FitRequest request = {.scene = {.system = PlanarContact{3.0, 0.0, 2.0, 0.0, -1.0},
                                          .restitution = EnergeticCoefficient{1.0},
                                          .compliance = Compliance{.normal = LinearSpring{.stiffness_n_m = start}}},
                                .unknowns = {{.path = "compliance.linear.stiffness_n_m"}},
                                .measured = {{"contact.duration_s", {0.002, 0.00202, 0.00198}, {4e-5}}}};
    const FitResponse response = *Fit(request, Never);
    const FitEstimate& found = response.unknowns[0];
    EXPECT_NEAR(found.value, right, 1e-5 * right) << start;
    ASSERT_EQ(found.low.kind, FitEndKind::kFound) << start;
    const double chi2 = ChiSquaredAt(request, {*found.low.value}) - response.chi2;
    EXPECT_NEAR(chi2, 3.841458820694124, 1e-2) << start;
    EXPECT_TRUE(response.thresholds.empty()) << start;
  }
}

// The normal velocity tells the coefficient, the tangential one the friction, however exact the former is.
TEST(FitTest, AnExactColumnHidesNoOther) {
  for (const double sigma : {1e-2, 1e-6, 1e-10}) {
    const FitRequest request = {
        .scene = {.system = PlanarContact{2.0, 0.0, 1.0, 1.0, -1.0},
                  .friction = {.kinetic_coefficient = 0.1},
                  .restitution = NewtonCoefficient{0.5}},
        .unknowns = {{.path = "friction.kinetic_coefficient"}, {.path = "restitution.newton"}},
        .measured = {{"contact_velocity_after.tangential_m_s[0]", {0.6, 0.8}, {0.1}},
                     {"contact_velocity_after.normal_m_s", {0.5 - sigma, 0.5 + sigma}, {sigma}}}};
    const FitResponse response = *Fit(request, Never);
    EXPECT_EQ(response.degrees_of_freedom, 2) << sigma;
    EXPECT_NEAR(response.chi2, 4.0, 1e-5) << sigma;
    EXPECT_NEAR(response.unknowns[0].value, 0.1, 1e-6) << sigma;
    EXPECT_NEAR(response.unknowns[0].sigma.value_or(0.0), 0.1 / (3.0 * std::sqrt(2.0)), 1e-2 * sigma + 1e-7) << sigma;
  }
}

// The tangential velocity tells mu (1 + e) alone, and the normal one e.
TEST(FitTest, AnExactCombinationHidesNoOther) {
  for (const double exact : {1e-3, 1e-6, 1e-8}) {
    const FitRequest request = {
        .scene = {.system = PlanarContact{2.0, 0.0, 1.0, 1.0, -1.0},
                  .friction = {.kinetic_coefficient = 0.1},
                  .restitution = NewtonCoefficient{0.5}},
        .unknowns = {{.path = "friction.kinetic_coefficient"}, {.path = "restitution.newton"}},
        .measured = {{"contact_velocity_after.tangential_m_s[0]", {0.7 - exact, 0.7 + exact}, {exact}},
                     {"contact_velocity_after.normal_m_s", {0.4, 0.6}, {0.1}}}};
    const FitResponse response = *Fit(request, Never);
    EXPECT_EQ(response.degrees_of_freedom, 2) << exact;
    EXPECT_NEAR(response.unknowns[1].sigma.value_or(0.0), 0.1 / std::sqrt(2.0), 1e-6) << exact;
    EXPECT_NEAR(response.unknowns[0].sigma.value_or(0.0), 0.1 / 1.5 * 0.1 / std::sqrt(2.0), 1e-5) << exact;
  }
}

// A contact that sticks moves along t by rounding alone, whose slopes by friction are nothing beside its velocities.
TEST(FitTest, RoundingTellsNothing) {
  for (const double slip : {0.3, 0.5, 0.7, 0.9}) {
    const FitRequest request = {.scene = {.system = PlanarContact{3.5, 0.0, 1.0, slip, -1.0},
                                          .friction = {.kinetic_coefficient = 1.1},
                                          .restitution = EnergeticCoefficient{0.5},
                                          .compliance = Compliance{.normal = LinearSpring{.stiffness_n_m = 1e6}}},
                                .unknowns = {{.path = "friction.kinetic_coefficient"}},
                                .measured = {{"contact_velocity_after.tangential_m_s[0]", {0.0, 0.0}, {1e-3}},
                                             {"contact_velocity_after.normal_m_s", {0.5, 0.5}, {1e-3}}}};
    const FitEstimate found = Fit(request, Never)->unknowns[0];
    EXPECT_FALSE(found.seen) << slip;
    EXPECT_FALSE(found.sigma.has_value()) << slip;
    EXPECT_EQ(found.high.kind, FitEndKind::kNotSeen) << slip;
  }
}

// e v (1 - alpha v^n) over speeds that differ by 1 % is a straight line, whichever of e, alpha and n is far off. For
// each n the others are found by linear regression, which gives the least chi-squared: 12.63562 and 1.38479. The first
// lies where n falls to 0 and e grows beyond what doubles resolve; the second set also fits with e = 0.001 and n = 0.3.
TEST(FitTest, ThreeUnknownsOfALineHaveNoEndWhereRoundingIsAllThatTheyChange) {
  struct Case {
    std::vector<double> normal_after;
    double least_chi2;
  };
  for (const auto& [normal_after, least_chi2] :
       {Case{{1.8244, 0.907, 1.5038, 1.3086, 1.3336, 1.3829, 1.024, 1.3836}, 12.63562},
        Case{{1.4414, 1.3918, 1.5482, 1.4431, 1.317, 1.4984, 1.6888, 1.6194}, 1.38479}}) {
    FitRequest request = {
        .scene = {.system = PlanarContact{3.0, 0.5, 1.0, 0.3, -1.0},
                  .friction = {.kinetic_coefficient = 0.2},
                  .restitution = NewtonCoefficient{0.8},
                  .restitution_by_speed = PowerLaw{.alpha = 0.1, .exponent = 0.3}},
        .unknowns = {{.path = "restitution.newton"},
                     {.path = "restitution.by_speed.power_law.alpha"},
                     {.path = "restitution.by_speed.power_law.exponent"}},
        .inputs = {{.path = "planar_contact.normal_m_s",
                    .values = {-2.0, -2.002857, -2.005714, -2.008571, -2.011429, -2.014286, -2.017143, -2.02}}},
        .measured = {{"contact_velocity_after.normal_m_s", normal_after, {0.2}}}};
    const FitResponse response = *Fit(request, Never);
    EXPECT_GT(response.chi2, least_chi2 - 1e-3);
    const FitEstimate& newton = response.unknowns[0];
    EXPECT_EQ(newton.low.kind, FitEndKind::kCutByBound);
    EXPECT_EQ(newton.high.kind, FitEndKind::kUnbounded);
  }
}

// A number that is far from its start, and measured to nearly all its digits, is found: nothing cancels.
TEST(FitTest, ANumberFarFromItsStartIsFoundToAllItsDigits) {
  for (const double start : {-2.0, -0.9, -0.5}) {
    const FitRequest request = {.scene = {.system = PlanarContact{3.0, 0.5, 1.0, 0.3, start},
                                          .friction = {.kinetic_coefficient = 0.2},
                                          .restitution = NewtonCoefficient{0.5}},
                                .unknowns = {{.path = "planar_contact.normal_m_s"}},
                                .measured = {{"contact_velocity_after.normal_m_s", {500.0, 500.0, 500.0}, {1e-11}}}};
    const FitResponse response = *Fit(request, Never);
    EXPECT_NEAR(response.unknowns[0].value, -1000.0, 1e-10) << start;
    EXPECT_EQ(response.unknowns[0].low.kind, FitEndKind::kFound) << start;
  }
}

// The slip sticks at once and takes u0^2 / (2 Wtt) of energy: its sign is told by an impulse of large error alone.
TEST(FitTest, AnIntervalReachesOverAnotherFitThatIsNearlyAsGood) {
  const FitRequest request = {
      .scene = {.system = PlanarContact{1.0, 0.0, 1.0, 0.8, -1.0},
                .friction = {.kinetic_coefficient = 5.0},
                .restitution = EnergeticCoefficient{1.0}},
      .unknowns = {{.path = "planar_contact.tangential_m_s", .low = -3.0, .high = 3.0}},
      .measured = {{"energy_change_j", {-0.5}, {0.01}}, {"impulse.tangential_n_s[0]", {-1.0}, {2.0}}},
      .starts = 8};
  const FitResponse response = *Fit(request, Never);
  const FitEstimate& found = response.unknowns[0];
  EXPECT_NEAR(found.value, 1.0, 1e-6);
  EXPECT_TRUE(response.starts_differ);
  for (const FitEnd& end : {found.low, found.high}) {
    ASSERT_EQ(end.kind, FitEndKind::kFound);
    EXPECT_NEAR(ChiSquaredAt(request, {*end.value}) - response.chi2, 3.841458820694124, 1e-3);
  }
  EXPECT_NEAR(*found.low.value, -1.0 - 0.01 * std::sqrt(2.84), 1e-3);
  const auto is_between = [](const FitProfilePoint& point) { return point.value < -0.9; };
  EXPECT_TRUE(std::any_of(found.profile.begin(), found.profile.end(), is_between));
}

// Where w_tt and the friction change, their product alone is measured well. At each held w_tt the best friction is near
// 1.26/w_tt; searches that start elsewhere end where all rows stick, which changes nothing.
TEST(FitTest, AProfileFollowsAnUnknownThatIsCorrelatedWithTheOneHeld) {
  FitRequest request = {
      .scene = {.system = PlanarContact{.w_tt_per_kg = 3.0, .w_tn_per_kg = 0.05, .w_nn_per_kg = 1.0},
                .friction = {.kinetic_coefficient = 0.42},
                .restitution = PoissonCoefficient{0.84}},
      .unknowns = {{.path = "planar_contact.w_tt_per_kg"}, {.path = "friction.kinetic_coefficient"}},
      .inputs = {{"planar_contact.tangential_m_s", {0.093, 1.793, -0.187, 0.033, 1.063, 1.703}},
                 {"planar_contact.normal_m_s", {-0.74, -0.73, -1.05, -1.76, -1.82, -0.68}}},
      .measured = {{"contact_velocity_after.tangential_m_s[0]", {-0.001, 0.137, -0.007, 0.029, 0.014, 0.168}, {0.02}},
                   {"contact_velocity_after.normal_m_s", {0.638, 0.647, 0.886, 1.448, 1.54, 0.585}, {0.02}}}};
  const FitResponse response = *Fit(request, Never);
  for (const auto& [w_tt, friction] : {std::pair(3.0, 0.4181), {5.04, 0.2509}, {8.0, 0.1588}, {50.0, 0.0256}}) {
    ASSERT_LT(ChiSquaredAt(request, {w_tt, friction}) - response.chi2, 1.0);
    for (const auto& [k, value] : {std::pair(0, w_tt), {1, friction}}) {
      const FitEstimate& estimate = response.unknowns[static_cast<size_t>(k)];
      EXPECT_LT(estimate.low.value.value_or(value - 1.0), value) << estimate.path;
      EXPECT_GT(estimate.high.value.value_or(value + 1.0), value) << estimate.path;
    }
  }
}

TEST(FitTest, ResidualsWithoutASquareAreRefused) {
  FitRequest request = Noiseless(ContactCase());
  request.measured[0].values[3] = 1e200;
  for (const FitLoss loss : {FitLoss::kSquares, FitLoss::kCauchy}) {
    request.loss = loss;
    const absl::Status status = Fit(request, Never).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kOutOfRange) << status;
    EXPECT_THAT(std::string(status.message()), HasSubstr("rows[3].residuals[0]"));
  }
}

// Where friction locks the pendulum, any coefficient fits.
TEST(FitTest, AnIntervalGoesOnWhereAnotherUnknownLeavesItsBestValue) {
  for (const double friction : {0.3, 0.5}) {
    FitRequest request = {
        .scene = {.system = Pendulum{.inertia_kg_m2 = 1.0, .a_m = 0.3}, .restitution = NewtonCoefficient{0.5}},
        .unknowns = {{.path = "friction.kinetic_coefficient", .start = friction}, {.path = "restitution.newton"}},
        .inputs = {{"pendulum.b_m", {0.85, 0.98, 0.80}}, {"pendulum.omega_minus_rad_s", {-2.0, -4.5, -2.0}}},
        .measured = {{"rates_after_rad_s[0]", {0.013, 0.028, 0.002}, {0.02}}}};
    const FitResponse response = *Fit(request, Never);
    ASSERT_LT(ChiSquaredAt(request, {0.5, 0.9}) - response.chi2, 3.84);
    EXPECT_EQ(response.unknowns[1].high.kind, FitEndKind::kUnbounded) << friction;
  }
}

// The angles at which the data fit lie in a valley that is a hundredth wide.
TEST(FitTest, ANarrowValleyIsFoundFromNearbyAndAnAngleIsThatNextToItsStart) {
  Scene chain = {.system = Linkage{.links = {{.length_m = 1.0,
                                              .mass_kg = 1.0,
                                              .com_m = 0.5,
                                              .inertia_com_kg_m2 = 0.09,
                                              .theta_rad = 0.5,
                                              .rate_rad_s = -0.5},
                                             {.length_m = 0.8,
                                              .mass_kg = 0.7,
                                              .com_m = 0.3,
                                              .inertia_com_kg_m2 = 0.05,
                                              .theta_rad = 0.9,
                                              .rate_rad_s = -1.5}}},
                 .friction = {.kinetic_coefficient = 0.7423795316495276},
                 .restitution = EnergeticCoefficient{0.7946213634931437}};
  for (const double start : {0.45, 0.4712, 0.5, 0.52}) {
    const FitRequest request = {
        .scene = chain,
        .unknowns = {{.path = "linkage.links[0].theta_rad", .start = start}},
        .inputs = {{"linkage.links[1].theta_rad", {1.1544, 0.50638, 0.47669, 0.45241, 0.36307, 0.71218}}},
        .measured = {{"rates_after_rad_s[0]", {-0.66007, -0.83291, 0.72487, 0.70549, 0.68902, -0.84458}, {0.02}},
                     {"rates_after_rad_s[1]", {1.8374, 1.0221, -0.83933, -0.85179, -0.76323, 1.3986}, {0.02}}}};
    const FitResponse response = *Fit(request, Never);
    EXPECT_FALSE(response.refused) << start;
    EXPECT_NEAR(response.unknowns[0].value, 0.50638, 2e-3) << start;
    EXPECT_LT(response.chi2, 8.0) << start;
  }
}

TEST(FitTest, AStopEndsIt) {
  int questions = 0;
  const auto stop = [&questions] { return ++questions > 20; };
  EXPECT_EQ(Fit(Noiseless(CompliantCase()), stop).status().code(), absl::StatusCode::kCancelled);
}

// All questions here come from the audits themselves, because the rows are solved without one.
TEST(FitTest, AStopEndsTheAuditsOfTheRows) {
  const Problem problem = *CheckFit(Noiseless(ContactCase()));
  for (const int last : {3, 1000}) {
    int questions = 0;
    const auto stop = [&questions, last] { return ++questions > last; };
    ParallelBatch rows(problem.batch, nullptr);
    Model model(
        problem, [&rows](const BatchRows& all, absl::FunctionRef<bool()>) { return rows.Solve(all, Never); }, stop);
    FitResponse response = {.unknowns = std::vector<FitEstimate>(2), .starts = {{.converged = true}}};
    const Information information = {.is_at_bound = {false, false}, .is_seen = {true, true}};
    Judge(problem, ContactCase().true_values, information, model, response);
    EXPECT_EQ(model.is_stopped(), last == 3);
    EXPECT_GE(questions, last == 3 ? 4 : static_cast<int>(problem.rows));
  }
}

// The covariance of straight lines is that of their normal equations, whose sums are known in closed form.
TEST(FitTest, ManyRowsOfInformationAskForAStopAndTellTheSame) {
  Problem problem = *CheckFit(Noiseless(ContactCase()));
  constexpr size_t kCount = 20000;
  problem.rows = kCount;
  problem.numbers.clear();
  LinearResiduals residuals = {.values = std::vector<double>(kCount, 0.0), .sigmas = std::vector<double>(kCount, 0.5)};
  for (size_t i = 0; i < kCount; ++i) {
    problem.numbers.push_back({.row = i, .value = 1.0, .sigma = 0.5});
    residuals.slopes.insert(residuals.slopes.end(), {-2.0, -2.0 * static_cast<double>(i + 1) / kCount});
  }
  int questions = 0;
  const auto count = [&questions] { return ++questions < 0; };
  const Information information = InformationOf(problem, {0.5, 0.5}, residuals, count);
  EXPECT_GE(questions, 8);
  constexpr double kAll = kCount;
  const double linear = (kAll + 1.0) / 2.0, square = (kAll + 1.0) * (2.0 * kAll + 1.0) / (6.0 * kAll);
  const double determinant = kAll * square - linear * linear;
  EXPECT_NEAR(information.covariance[0], 0.25 * square / determinant, 1e-13 * square / determinant);
  EXPECT_NEAR(information.covariance[1], -0.25 * linear / determinant, 1e-13 * linear / determinant);
  EXPECT_NEAR(information.covariance[3], 0.25 * kAll / determinant, 1e-13 * kAll / determinant);
  EXPECT_EQ(information.degrees_of_freedom, static_cast<int64_t>(kCount) - 2);
}

// The rises are E[psi^2]/E[psi'] by adaptive quadrature in SciPy. The variances are those of 95 % efficiency at the
// default scales, that of the median for a narrow loss (pi/2), and that of the mean for a wide one.
TEST(FitTest, ARobustLossSpreadsNormalResidualsAsItsEfficiencySays) {
  Problem problem = *CheckFit(Noiseless(ContactCase()));
  const auto spread = [&problem](FitLoss loss, double scale) {
    problem.loss = loss;
    problem.loss_scale = scale;
    return SpreadOf(problem, {}, 0);
  };
  EXPECT_NEAR(spread(FitLoss::kHuber, kHuberScale).rise, 0.8646047798852482, 1e-4);
  EXPECT_NEAR(spread(FitLoss::kCauchy, kCauchyScale).rise, 0.7340955537844267, 1e-6);
  EXPECT_NEAR(spread(FitLoss::kHuber, 0.5).rise, 0.48345864749375655, 1e-4);
  EXPECT_NEAR(spread(FitLoss::kCauchy, 1.0).rise, 0.4521356166648463, 1e-6);
  EXPECT_NEAR(spread(FitLoss::kHuber, kHuberScale).variance, 1.0 / 0.95, 1e-4);
  EXPECT_NEAR(spread(FitLoss::kCauchy, kCauchyScale).variance, 1.0 / 0.95, 1e-4);
  EXPECT_NEAR(spread(FitLoss::kHuber, kLeastFitLossScale).variance, std::numbers::pi / 2.0, 1e-2);
  EXPECT_NEAR(spread(FitLoss::kHuber, 1e6).variance, 1.0, 1e-6);
  EXPECT_NEAR(spread(FitLoss::kCauchy, 1e6).variance, 1.0, 1e-6);
}

// Half of the residuals are outliers, whose psi is the scale and whose psi' is 0: psi^2 has the mean 0.5 c^2, and psi'
// the mean 0.5.
TEST(FitTest, OutliersSpreadARobustFitByTheirShare) {
  Problem problem = *CheckFit(Noiseless(ContactCase()));
  problem.loss = FitLoss::kHuber;
  problem.loss_scale = 2.0;
  const std::vector<double> half = {0.0, 0.0, 0.0, 0.0, 10.0, -10.0, 20.0, -20.0};
  EXPECT_NEAR(SpreadOf(problem, half, 8).rise, 4.0, 1e-12);
  EXPECT_NEAR(SpreadOf(problem, half, 4).rise, 8.0, 1e-12);
  EXPECT_NEAR(SpreadOf(problem, half, 4).variance, 16.0, 1e-12);
}

// A rod in a plane that falls at 2 m/s, with the restitution and the rows of a test.
FitRequest FallingRod(Restitution restitution, const std::string& coefficient, double offset_t,
                      std::vector<double> slip, std::vector<FitMeasured> measured) {
  return {.scene = {.system = PlanarBody{.mass_kg = 1.0,
                                         .inertia_com_kg_m2 = 0.02,
                                         .offset_t_m = offset_t,
                                         .offset_n_m = -0.2,
                                         .velocity_n_m_s = -2.0},
                    .friction = {.kinetic_coefficient = 0.3},
                    .restitution = restitution},
          .unknowns = {{.path = "friction.kinetic_coefficient", .start = 0.3, .low = 0.0, .high = 1.5},
                       {.path = coefficient, .start = 0.5, .low = 0.0, .high = 1.0}},
          .inputs = {{"planar_body.velocity_t_m_s", std::move(slip)}},
          .measured = std::move(measured)};
}

FitResponse Answer(const FitRequest& request) {
  const absl::StatusOr<FitResponse> response = Fit(request, [] { return false; });
  EXPECT_TRUE(response.ok()) << response.status();
  return response.value_or(FitResponse());
}

// The numbers are those of friction 0.1168 and an energetic coefficient of 0.0213, but from the start the search ends
// with a chi2 of 5553.
TEST(FitTest, AsManyUnknownsAsNumbersAreFoundFromElsewhere) {
  FitRequest request = FallingRod(EnergeticCoefficient{0.5}, "restitution.energetic", 0.1, {-0.4396668, 0.5303894},
                                  {{"bodies_after[0].angular_rad_s[0]", {-2.58814825, -6.45696549}, {0.013}}});
  request.inputs.push_back({"planar_body.offset_t_m", {-0.05043773, -0.10525978}});
  const FitResponse response = Answer(request);
  EXPECT_LT(response.chi2, 1e-6);
  EXPECT_NEAR(response.unknowns[0].value, 0.1168, 1e-3);
  EXPECT_NEAR(response.unknowns[1].value, 0.0213, 1e-3);
}

// Friction between 0.19 and 0.28 fits as well as the best, and so does any coefficient from the best one to 1: a search
// by brute force finds rises below 0.3. On the plateau where all rows stick the rise is 3.66.
TEST(FitTest, AProfileLeavesAPlateauWhereOtherPlacesFit) {
  FitRequest request =
      FallingRod(PoissonCoefficient{0.5}, "restitution.poisson", -0.00717235,
                 {-1.73611610, 0.02204858, -0.88257178, 0.37269286, 0.43176915, 1.70942763, 0.21281176},
                 {{"contact_velocity_after.tangential_m_s[0]",
                   {-0.01961597, 0.01145066, 0.00004808, -0.00260780, -0.00349178, -0.01512995, -0.00069169},
                   {0.00965649}}});
  request.loss = FitLoss::kHuber;
  const FitResponse response = Answer(request);
  EXPECT_NE(response.unknowns[1].high.kind, FitEndKind::kFound);
  for (const FitProfilePoint& point : response.unknowns[0].profile) {
    if (point.value > 0.19 && point.value < 0.28) {
      EXPECT_LT(point.rise, 0.1) << point.value;
    }
  }
}

// Offsets of 0.1 m and of -0.1 m give the same numbers.
TEST(FitTest, OfMinimaThatFitAlikeTheOneNearTheStartIsTaken) {
  FitRequest request = {.scene = {.system = PlanarBody{.mass_kg = 1.0,
                                                       .inertia_com_kg_m2 = 0.05,
                                                       .offset_t_m = 0.1,
                                                       .offset_n_m = -0.2,
                                                       .velocity_n_m_s = -1.0},
                                  .friction = {.kinetic_coefficient = 0.0},
                                  .restitution = NewtonCoefficient{0.5}},
                        .unknowns = {{.path = "planar_body.offset_t_m", .start = 0.05, .low = -0.3, .high = 0.3}},
                        // Without friction tau = 1.5/(1 + a^2/0.05), and v ends at tau - 1.
                        .measured = {{"bodies_after[0].linear_m_s[1]", std::vector<double>(5, 0.25), {0.001}}}};
  for (const int starts : {1, 2, 3, 5, 8}) {
    request.starts = starts;
    EXPECT_NEAR(Answer(request).unknowns[0].value, 0.1, 1e-6) << starts;
  }
}

// The rates of the double pendulum create energy (Kane and Levinson, 1985), and a body that falls at 2 m/s cannot rise
// at 3.5 m/s.
TEST(FitTest, VelocitiesOfLinksAndBodiesAreAuditedToo) {
  const auto rod = [](double theta, double rate) {
    return Link{.length_m = 1,
                .mass_kg = 1,
                .com_m = 0.5,
                .inertia_com_kg_m2 = 1.0 / 12.0,
                .theta_rad = theta,
                .rate_rad_s = rate};
  };
  const FitResponse links =
      Answer({.scene = {.system = Linkage{.links = {rod(0.3490658503988659, -0.1), rod(0.5235987755982988, -0.2)}},
                        .friction = {.kinetic_coefficient = 0.7},
                        .restitution = NewtonCoefficient{0.5}},
              .unknowns = {{.path = "restitution.newton"}},
              .measured = {{"rates_after_rad_s[0]", {-0.6692978596871272, -0.6692978596871272}, {0.001}},
                           {"rates_after_rad_s[1]", {0.7262307284606437, 0.7262307284606437}, {0.001}}}});
  EXPECT_TRUE(links.refused);
  EXPECT_THAT(links.rows[1].broken_limits, Contains(AuditLimit::kEnergy));
  EXPECT_THAT(links.notes, Contains(HasSubstr("The best fit itself is inadmissible in 2 rows, first in row 0")));
  const FitRequest falls = FallingRod(NewtonCoefficient{0.5}, "restitution.newton", 0.0, {0.0, 0.0},
                                      {{"bodies_after[0].linear_m_s[0]", {0.0, 0.0}, {0.01}},
                                       {"bodies_after[0].linear_m_s[1]", {3.5, 1.0}, {0.01}},
                                       {"bodies_after[0].angular_rad_s[0]", {0.0, 0.0}, {0.01}}});
  const FitResponse body = Answer(falls);
  EXPECT_THAT(body.rows[0].broken_limits, Contains(AuditLimit::kEnergy));
  EXPECT_THAT(body.rows[1].broken_limits, IsEmpty());
  EXPECT_THAT(body.notes, Not(Contains(HasSubstr("inadmissible"))));
}

// With the truth on both bounds, half of the data would fit better beyond each.
TEST(FitTest, TheProbabilityOfChiSquaredIsThatOfDataWhoseTruthLiesOnBounds) {
  constexpr int kSets = 1000;
  Case given = ContactCase();
  given.truth.friction.kinetic_coefficient = 0.0;
  given.truth.restitution = PoissonCoefficient{1.0};
  given.unknowns[0].start = 0.1;
  given.unknowns[1].high = 1.0;
  for (FitInput& input : given.inputs) input.values.resize(2);
  const FitRequest exact = Noiseless(given);
  Noise noise(20261129);
  int rare = 0;
  for (int set = 0; set < kSets; ++set) {
    const FitResponse response = Answer(noise.AddedTo(exact));
    ASSERT_TRUE(response.p_value.has_value());
    rare += *response.p_value < 0.05 ? 1 : 0;
  }
  EXPECT_GE(rare, 0.03 * kSets);
  EXPECT_LE(rare, 0.07 * kSets);
}

// The best fit lies on the bound e = 1, along which the region goes to both sides.
TEST(FitTest, ARegionOnABoundGoesAlongItToBothSides) {
  Case given = ContactCase();
  given.unknowns[1].high = 1.0;
  FitRequest request = Noiseless(given);
  for (double& value : request.measured[1].values) value = std::fabs(value) * 1.8;
  request.region = {"friction.kinetic_coefficient", "restitution.poisson"};
  const FitResponse response = Answer(request);
  ASSERT_EQ(response.unknowns[1].value, 1.0);
  const auto count = [&](double side) {
    return std::count_if(response.region.begin(), response.region.end(), [&](const FitRegionPoint& point) {
      return point.y == 1.0 && side * (point.x - response.unknowns[0].value) > 0.0;
    });
  };
  EXPECT_GE(count(-1.0), 1);
  EXPECT_GE(count(1.0), 1);
  for (const FitRegionPoint& point : response.region) EXPECT_LE(point.y, 1.0);
}

// Six throws of a disk on a tangential spring, made with mu = 0.648, e = 0.87 and a ratio of 0.446, with errors of 0.01
// and 0.5. There are minima far above the least one, which a search from the start finds.
TEST(FitTest, AFitWithComplianceDoesNotDependOnTheOrderOfUnknowns) {
  FitRequest request = {
      .scene = {.system = PlanarBody{.mass_kg = 0.1,
                                     .inertia_com_kg_m2 = 4e-5,
                                     .offset_t_m = 0.008,
                                     .offset_n_m = -0.03,
                                     .velocity_n_m_s = -2.0},
                .friction = {.kinetic_coefficient = 0.3},
                .restitution = EnergeticCoefficient{0.7},
                .compliance = Compliance{.tangential_ratio_squared = 1.0}},
      .unknowns = {{.path = "friction.kinetic_coefficient"},
                   {.path = "restitution.energetic"},
                   {.path = "compliance.tangential_ratio_squared", .low = 0.2, .high = 5.0}},
      .inputs = {{"planar_body.velocity_t_m_s", {-0.3737, -2.6942, -0.2578, 1.0642, 0.2092, -0.2354}},
                 {"planar_body.velocity_n_m_s", {-1.4559, -1.5076, -1.6989, -1.9137, -2.1071, -2.6152}},
                 {"planar_body.rate_rad_s", {-16.8843, 8.0362, 31.9064, 24.5285, -10.0968, -29.1422}}},
      .measured = {{"bodies_after[0].linear_m_s[0]", {-0.7347, -2.0273, -0.9552, 0.0330, -0.5587, -0.9865}, {0.01}},
                   {"bodies_after[0].linear_m_s[1]", {1.0314, 0.2800, 1.0993, 1.7868, 1.7665, 2.0828}, {0.01}},
                   {"bodies_after[0].angular_rad_s[0]", {6.4350, 93.9230, 37.4574, 20.0065, 9.3933, 7.9237}, {0.5}}}};
  FitUnknown truth[] = {{.path = request.unknowns[0].path, .start = 0.648},
                        {.path = request.unknowns[1].path, .start = 0.87},
                        {.path = request.unknowns[2].path, .start = 0.446, .low = 0.2, .high = 5.0}};
  FitRequest from_truth = request;
  from_truth.unknowns.assign(std::begin(truth), std::end(truth));
  const absl::StatusOr<FitResponse> least = Fit(from_truth, Never);
  ASSERT_TRUE(least.ok()) << least.status();
  EXPECT_FALSE(least->refused);
  for (const std::vector<size_t>& order : std::vector<std::vector<size_t>>{{0, 1, 2}, {1, 0, 2}, {2, 1, 0}}) {
    FitRequest permuted = request;
    for (size_t k = 0; k < order.size(); ++k) permuted.unknowns[k] = request.unknowns[order[k]];
    const absl::StatusOr<FitResponse> response = Fit(permuted, Never);
    ASSERT_TRUE(response.ok()) << response.status();
    EXPECT_NEAR(response->chi2, least->chi2, 1e-3);
  }
}

TEST(FitTest, ADeadlineEndsIt) {
  const CallOptions late = {.deadline = std::chrono::steady_clock::now() + std::chrono::milliseconds(2)};
  FitRequest request = Noiseless(CompliantCase());
  request.starts = 1000;
  EXPECT_EQ(LocalSolver().Fit(request, late).status().code(), absl::StatusCode::kDeadlineExceeded);
}

// Abramowitz and Stegun, Table 26.8.
TEST(FitTest, ChiSquaredHasItsTabulatedProbabilities) {
  EXPECT_NEAR(ChiSquaredBeyond(3.841458820694124, 1.0), 0.05, 1e-13);
  EXPECT_NEAR(ChiSquaredBeyond(5.991464547107979, 2.0), 0.05, 1e-13);
  EXPECT_NEAR(ChiSquaredBeyond(18.307038053275146, 10.0), 0.05, 1e-13);
  EXPECT_NEAR(ChiSquaredBeyond(0.01, 3.0), 0.99973, 1e-5);
  EXPECT_EQ(ChiSquaredBeyond(0.0, 4.0), 1.0);
}

}  // namespace
}  // namespace ricochet::fit
