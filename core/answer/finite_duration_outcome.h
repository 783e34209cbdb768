// MakeOutcome for an impact that takes time.

#ifndef RICOCHET_CORE_ANSWER_FINITE_DURATION_OUTCOME_H_
#define RICOCHET_CORE_ANSWER_FINITE_DURATION_OUTCOME_H_

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "core/answer/outcome_parts.h"
#include "core/contact/reduction.h"
#include "core/models/finite_duration/finite_duration.h"
#include "ricochet/outcome.h"

namespace ricochet::finite_duration {

// `problem` must be that of `reduction`.
// Errors: OUT_OF_RANGE names the first output that exceeds the largest double; INVALID_ARGUMENT if `history_at_n_s` is
// not empty, because histories of such an impact are in time (Problem::intervals).
absl::StatusOr<Outcome> MakeOutcome(const Problem& problem, const PlanarReduction& reduction,
                                    absl::Span<const double> history_at_n_s, absl::FunctionRef<bool()> stopped,
                                    Detail detail = Detail::kAll);

}  // namespace ricochet::finite_duration

#endif  // RICOCHET_CORE_ANSWER_FINITE_DURATION_OUTCOME_H_
