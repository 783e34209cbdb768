// MakeOutcome for an impact in space: contact velocities, works, timeline, limits broken, velocities of the system.

#ifndef RICOCHET_CORE_ANSWER_SPATIAL_OUTCOME_H_
#define RICOCHET_CORE_ANSWER_SPATIAL_OUTCOME_H_

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "core/answer/outcome_parts.h"
#include "core/contact/reduction.h"
#include "core/models/spatial/spatial.h"
#include "ricochet/outcome.h"
#include "ricochet/scene.h"

namespace ricochet::spatial {

// `problem` must be that of `reduction`. The path between events is not kept, so that there is no history.
// Errors: OUT_OF_RANGE names the first output that exceeds the largest double; INVALID_ARGUMENT if
// `history_at_n_s` is not empty.
absl::StatusOr<Outcome> MakeOutcome(const Problem& problem, const SpatialReduction& reduction,
                                    absl::Span<const double> history_at_n_s, Detail detail = Detail::kAll);

}  // namespace ricochet::spatial

#endif  // RICOCHET_CORE_ANSWER_SPATIAL_OUTCOME_H_
