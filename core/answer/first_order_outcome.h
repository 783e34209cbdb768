// MakeOutcome for a nearly vertical pendulum to first order.

#ifndef RICOCHET_CORE_ANSWER_FIRST_ORDER_OUTCOME_H_
#define RICOCHET_CORE_ANSWER_FIRST_ORDER_OUTCOME_H_

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "core/answer/outcome_parts.h"
#include "core/models/pendulum/first_order.h"
#include "ricochet/outcome.h"

namespace ricochet::first_order {

// Outputs have the paths of pendulum::MakeOutcome (core/answer/pendulum_outcome.h). The model must serve `problem`.
// Errors: INVALID_ARGUMENT for each history_at_n_s that is not in [0, tau1].
absl::StatusOr<Outcome> MakeOutcome(const Problem& problem, absl::Span<const double> history_at_n_s,
                                    Detail detail = Detail::kAll);

}  // namespace ricochet::first_order

#endif  // RICOCHET_CORE_ANSWER_FIRST_ORDER_OUTCOME_H_
