// An impact with tangential compliance as an Outcome.

#ifndef RICOCHET_CORE_ANSWER_COMPLIANT_OUTCOME_H_
#define RICOCHET_CORE_ANSWER_COMPLIANT_OUTCOME_H_

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "core/answer/outcome_parts.h"
#include "core/contact/reduction.h"
#include "core/models/compliant/compliant.h"
#include "ricochet/outcome.h"

namespace ricochet::compliant {

// The most events of a timeline; where there are more, it has the first ones and the end.
inline constexpr size_t kMostEvents = 8192;

// `problem` is of `reduction`.
// Errors: OUT_OF_RANGE naming the first output that exceeds the largest double; INVALID_ARGUMENT if `history_at_n_s` is
// not empty: what the springs do between two events is no line in the normal impulse.
absl::StatusOr<Outcome> MakeOutcome(const Problem& problem, const PlanarReduction& reduction,
                                    absl::Span<const double> history_at_n_s, Detail detail = Detail::kAll);

}  // namespace ricochet::compliant

#endif  // RICOCHET_CORE_ANSWER_COMPLIANT_OUTCOME_H_
