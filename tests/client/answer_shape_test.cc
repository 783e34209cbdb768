// Answers that a caller could not index are refused.

#include "client/answer_shape.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "ricochet/solver.h"
#include "tests/core/fit/fit_cases.h"
#include "tests/support/scenes/multi_contact_scenes.h"

namespace ricochet {
namespace {

template <typename Request, typename Response>
void ExpectRefused(const Request& request, const Response& right,
                   const std::vector<std::function<void(Response&)>>& changes) {
  EXPECT_TRUE(CheckShape(request, right).ok()) << CheckShape(request, right);
  for (size_t i = 0; i < changes.size(); ++i) {
    Response wrong = right;
    changes[i](wrong);
    const absl::Status status = CheckShape(request, wrong);
    EXPECT_EQ(status.code(), absl::StatusCode::kDataLoss) << "change " << i;
    EXPECT_THAT(std::string(status.message()), testing::StartsWith("the answer ")) << "change " << i;
  }
}

TEST(AnswerShape, OfImpacts) {
  const SolveRequest request = {.scene = {.system = Mechanism{.mass_matrix = {2.0, 0.3, 0.3, 1.5},
                                                              .jacobian = {1.0, 0.5, 0.2, 0.7},
                                                              .rates = {0.4, -1.9},
                                                              .kept_coordinates = {0}},
                                          .friction = {.kinetic_coefficient = 0.3},
                                          .restitution = EnergeticCoefficient{0.7}},
                                .history_intervals = 3,
                                .both_ends = true};
  const auto response = LocalSolver().Solve(request);
  ASSERT_TRUE(response.ok()) << response.status();
  using Response = SolveResponse;
  ExpectRefused<SolveRequest, Response>(
      request, *response,
      {[](Response& answer) { answer.outcome.contact_velocity_after.tangential_m_s.clear(); },
       [](Response& answer) { answer.outcome.impulse.tangential_n_s.push_back(0.0); },
       [](Response& answer) { answer.outcome.rates_after.pop_back(); },
       [](Response& answer) { answer.outcome.momentum_change.pop_back(); },
       [](Response& answer) { answer.outcome.errors.rates_after.clear(); },
       [](Response& answer) { answer.outcome.free_end->rates_after.clear(); },
       [](Response& answer) { answer.outcome.timeline[0].state.tangential_impulse_n_s.clear(); },
       [](Response& answer) { answer.outcome.history[1].contact_velocity.tangential_m_s.push_back(0.0); }});
}

TEST(AnswerShape, OfFits) {
  FitRequest request = fit::Noiseless(fit::ContactCase());
  request.starts = 2;
  const auto response = LocalSolver().Fit(request);
  ASSERT_TRUE(response.ok()) << response.status();
  ExpectRefused<FitRequest, FitResponse>(
      request, *response,
      {[](FitResponse& answer) { answer.unknowns.pop_back(); },
       [](FitResponse& answer) { answer.covariance.push_back(0.0); },
       [](FitResponse& answer) { answer.correlation.clear(); }, [](FitResponse& answer) { answer.rows.pop_back(); },
       [](FitResponse& answer) { answer.unknowns[0].row_shares.pop_back(); },
       [](FitResponse& answer) { answer.unknowns[0].low = {.kind = FitEndKind::kFound, .value = std::nullopt}; },
       [](FitResponse& answer) { answer.rows[0].predicted.clear(); },
       [](FitResponse& answer) { answer.rows[1].residuals.push_back(0.0); },
       [](FitResponse& answer) { answer.starts[1].to.pop_back(); }});
}

TEST(AnswerShape, OfSeveralContacts) {
  const MultiContactRequest request = {.scene = FallingBlock(0.7, 0.3),
                                       .outputs = {{.name = "top", .coefficients = {1.0, 0.0, -1.0}}},
                                       .stiffness_range = StiffnessRange{.contact = 2, .low = 0.1, .high = 10.0}};
  const auto response = LocalSolver().MultiContact(request);
  ASSERT_TRUE(response.ok()) << response.status();
  using Response = MultiContactResponse;
  ExpectRefused<MultiContactRequest, Response>(
      request, *response,
      {[](Response& answer) { answer.answers.clear(); },
       [](Response& answer) { answer.answers[0].contact_velocity_before_m_s.pop_back(); },
       [](Response& answer) { answer.answers[0].orders[0].contact_velocity_m_s.clear(); },
       [](Response& answer) { answer.answers[0].orders[0].contact_velocity_error_m_s.pop_back(); },
       [](Response& answer) { answer.answers[0].orders.back().velocity.push_back(0.0); },
       [](Response& answer) { answer.answers[0].springs->velocity_error.clear(); },
       [](Response& answer) { answer.answers[0].springs->impulse_n_s.pop_back(); },
       [](Response& answer) { answer.answers[0].springs->impulse_n_s.clear(); },
       [](Response& answer) { answer.answers[0].stiffness_samples[1].outcome.velocity.pop_back(); },
       [](Response& answer) { answer.answers[0].orders[0].contacts.pop_back(); },
       [](Response& answer) { answer.answers[0].possible.resize(2); }});
  MultiContactRequest without = request;
  without.stiffness_range.reset();
  EXPECT_EQ(CheckShape(without, *response).code(), absl::StatusCode::kDataLoss);
}

}  // namespace
}  // namespace ricochet
