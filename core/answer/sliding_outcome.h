// MakeOutcome for slip that neither stops nor turns, and for an impact without friction, in a plane and in space.

#ifndef RICOCHET_CORE_ANSWER_SLIDING_OUTCOME_H_
#define RICOCHET_CORE_ANSWER_SLIDING_OUTCOME_H_

#include <cstddef>

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "core/answer/outcome_parts.h"
#include "core/contact/reduction.h"
#include "core/models/sliding/sliding.h"
#include "ricochet/outcome.h"

namespace ricochet::sliding {

// `problem` must be that of `reduction`. The path is a straight line, so that there is a history in space, too.
// Errors: OUT_OF_RANGE names the first output that exceeds the largest double; INVALID_ARGUMENT for each
// history_at_n_s that is not in [0, tau1].
template <size_t kTangential>
absl::StatusOr<Outcome> MakeOutcome(const Problem<kTangential>& problem, const Reduction<kTangential>& reduction,
                                    absl::Span<const double> history_at_n_s, Detail detail = Detail::kAll);

// Makes the outcome of the impact without friction.
template <size_t kTangential>
absl::StatusOr<Outcome> MakeFrictionlessOutcome(const Problem<kTangential>& problem,
                                                const Reduction<kTangential>& reduction,
                                                absl::Span<const double> history_at_n_s, Detail detail = Detail::kAll);

}  // namespace ricochet::sliding

#endif  // RICOCHET_CORE_ANSWER_SLIDING_OUTCOME_H_
