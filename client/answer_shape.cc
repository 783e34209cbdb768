#include "client/answer_shape.h"

#include <algorithm>
#include <cstddef>
#include <variant>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"

namespace ricochet {
namespace {

// Compares lengths and keeps the first that is wrong.
class Lengths {
 public:
  template <typename List>
  void Expect(absl::string_view name, const List& list, size_t wanted) {
    if (list.size() == wanted || !status_.ok()) return;
    status_ = absl::DataLossError(absl::StrCat("the answer has ", list.size(), " ", name, " in place of ", wanted));
  }
  template <typename List>
  void ExpectOrNone(absl::string_view name, const List& list, size_t wanted) {
    if (!list.empty()) Expect(name, list, wanted);
  }
  void Require(bool holds, absl::string_view what) {
    if (!holds && status_.ok()) status_ = absl::DataLossError(absl::StrCat("the answer ", what));
  }
  const absl::Status& status() const { return status_; }

 private:
  absl::Status status_;
};

bool HasItsValue(const FitEnd& end) {
  return end.value.has_value() || (end.kind != FitEndKind::kFound && end.kind != FitEndKind::kCutByBound);
}

// All outcomes of one answer are of contacts with `numbers` velocities, and of a system with as many as the first has.
void CheckOutcome(size_t contacts, size_t numbers, size_t system, const AttainedOutcome& outcome, Lengths& lengths) {
  lengths.Expect("contact velocities", outcome.contact_velocity_m_s, numbers);
  lengths.Expect("errors of contact velocities", outcome.contact_velocity_error_m_s, numbers);
  lengths.Expect("velocities", outcome.velocity, system);
  lengths.Expect("errors of velocities", outcome.velocity_error, system);
  lengths.ExpectOrNone("errors of impulses", outcome.normal_impulse_error_n_s, contacts);
  lengths.ExpectOrNone("contacts", outcome.contacts, contacts);
  // Each of the contacts has an impulse.
  if (!outcome.contacts.empty() || !outcome.impulse_n_s.empty()) {
    lengths.Expect("impulses", outcome.impulse_n_s, numbers);
  }
}

void CheckAnswer(const MultiContactRequest& request, const MultiContactAnswer& answer, Lengths& lengths) {
  const size_t contacts = request.scene.contacts.size();
  const size_t numbers = contacts * static_cast<size_t>(DirectionsOf(request.scene));
  std::vector<const AttainedOutcome*> outcomes;
  for (const AttainedOutcome& outcome : answer.orders) outcomes.push_back(&outcome);
  if (answer.springs.has_value()) outcomes.push_back(&*answer.springs);
  for (const StiffnessSample& sample : answer.stiffness_samples) outcomes.push_back(&sample.outcome);
  lengths.Expect("velocities before", answer.contact_velocity_before_m_s, numbers);
  for (const AttainedOutcome* outcome : outcomes) {
    CheckOutcome(contacts, numbers, outcomes.front()->velocity.size(), *outcome, lengths);
  }
  const bool has_possible = answer.possible.empty() || answer.possible.size() >= numbers + request.outputs.size();
  lengths.Require(has_possible, "bounds fewer outputs than there are");
  lengths.Require(answer.stiffness_samples.empty() || request.stiffness_range.has_value(),
                  "varies a stiffness that the request does not");
}

// `end` is an Outcome or a FreeEnd.
template <typename End>
void CheckEnd(size_t tangential, size_t coordinates, const End& end, Lengths& lengths) {
  lengths.Expect("tangential velocities", end.contact_velocity_after.tangential_m_s, tangential);
  lengths.Expect("tangential impulses", end.impulse.tangential_n_s, tangential);
  lengths.Expect("rates", end.rates_after, coordinates);
}

void CheckState(size_t tangential, const State& state, Lengths& lengths) {
  lengths.Expect("tangential velocities of a state", state.contact_velocity.tangential_m_s, tangential);
  lengths.Expect("tangential impulses of a state", state.tangential_impulse_n_s, tangential);
}

}  // namespace

absl::Status CheckShape(const SolveRequest& request, const SolveResponse& response) {
  Lengths lengths;
  const Outcome& outcome = response.outcome;
  const size_t tangential = TangentialDirections(request.scene.system);
  const auto* const mechanism = std::get_if<Mechanism>(&request.scene.system);
  const size_t coordinates = mechanism == nullptr ? 0 : mechanism->rates.size();
  CheckEnd(tangential, coordinates, outcome, lengths);
  lengths.Expect("momenta", outcome.momentum_change, coordinates);
  lengths.Expect("errors of rates", outcome.errors.rates_after, coordinates);
  if (outcome.free_end.has_value()) CheckEnd(tangential, coordinates, *outcome.free_end, lengths);
  for (const Event& event : outcome.timeline) CheckState(tangential, event.state, lengths);
  for (const State& state : outcome.history) CheckState(tangential, state, lengths);
  return lengths.status();
}

absl::Status CheckShape(const FitRequest& request, const FitResponse& response) {
  Lengths lengths;
  const size_t unknowns = request.unknowns.size();
  const size_t columns = request.measured.size();
  const size_t rows = columns == 0 ? 0 : request.measured.front().values.size();
  lengths.Expect("unknowns", response.unknowns, unknowns);
  lengths.Expect("covariances", response.covariance, unknowns * unknowns);
  lengths.Expect("correlations", response.correlation, unknowns * unknowns);
  lengths.Expect("rows", response.rows, rows);
  for (const FitEstimate& unknown : response.unknowns) {
    lengths.ExpectOrNone("shares of rows", unknown.row_shares, rows);
    lengths.Require(HasItsValue(unknown.low) && HasItsValue(unknown.high), "has an interval without its end");
  }
  for (const FitRow& row : response.rows) {
    lengths.Expect("predictions in a row", row.predicted, columns);
    lengths.Expect("residuals in a row", row.residuals, columns);
  }
  for (const FitStart& start : response.starts) {
    lengths.Expect("unknowns of a start", start.from, unknowns);
    lengths.Expect("unknowns at the end of a search", start.to, unknowns);
  }
  return lengths.status();
}

absl::Status CheckShape(const MultiContactRequest& request, const MultiContactResponse& response) {
  Lengths lengths;
  lengths.Expect("answers", response.answers, std::max<size_t>(request.states.size(), 1));
  for (const MultiContactAnswer& answer : response.answers) CheckAnswer(request, answer, lengths);
  return lengths.status();
}

}  // namespace ricochet
