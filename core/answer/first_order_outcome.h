// A nearly vertical pendulum's impact to first order as an Outcome.

#ifndef RICOCHET_CORE_ANSWER_FIRST_ORDER_OUTCOME_H_
#define RICOCHET_CORE_ANSWER_FIRST_ORDER_OUTCOME_H_

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "core/answer/outcome_parts.h"
#include "core/models/pendulum/first_order.h"
#include "ricochet/outcome.h"

namespace ricochet::first_order {

// As pendulum::MakeOutcome, whose paths it uses (core/answer/pendulum_outcome.h). `problem` is one that the model
// serves.
// Errors: INVALID_ARGUMENT for each history_at_n_s that is not in [0, tau1].
absl::StatusOr<Outcome> MakeOutcome(const Problem& problem, absl::Span<const double> history_at_n_s,
                                    Detail detail = Detail::kAll);

}  // namespace ricochet::first_order

#endif  // RICOCHET_CORE_ANSWER_FIRST_ORDER_OUTCOME_H_
