// MakeOutcome for an impact with tangential compliance.

#ifndef RICOCHET_CORE_ANSWER_COMPLIANT_OUTCOME_H_
#define RICOCHET_CORE_ANSWER_COMPLIANT_OUTCOME_H_

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "core/answer/outcome_parts.h"
#include "core/contact/reduction.h"
#include "core/models/compliant/compliant.h"
#include "ricochet/outcome.h"

namespace ricochet::compliant {

// A timeline has at most this many events; if the impact has more, it has the first ones and the end.
inline constexpr size_t kMostEvents = 8192;

// `problem` must be that of `reduction`.
// Errors: OUT_OF_RANGE names the first output that exceeds the largest double; INVALID_ARGUMENT if `history_at_n_s` is
// not empty, because the path between two events is not linear in the normal impulse.
absl::StatusOr<Outcome> MakeOutcome(const Problem& problem, const PlanarReduction& reduction,
                                    absl::Span<const double> history_at_n_s, Detail detail = Detail::kAll);

}  // namespace ricochet::compliant

#endif  // RICOCHET_CORE_ANSWER_COMPLIANT_OUTCOME_H_
