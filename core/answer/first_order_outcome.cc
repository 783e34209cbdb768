#include "core/answer/first_order_outcome.h"

#include "core/answer/pendulum_outcome.h"

namespace ricochet::first_order {

absl::StatusOr<Outcome> MakeOutcome(const Problem& problem, absl::Span<const double> history_at_n_s, Detail detail) {
  const pendulum::Findings findings = {
      .impact = first_order::Solve(problem), .error = ErrorsOf(problem).velocity, .at = first_order::At};
  return pendulum::MakeOutcome(problem, findings, history_at_n_s, detail);
}

}  // namespace ricochet::first_order
