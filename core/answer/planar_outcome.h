// MakeOutcome for a planar impact: contact velocities, works, timeline, limits broken, velocities of the system.

#ifndef RICOCHET_CORE_ANSWER_PLANAR_OUTCOME_H_
#define RICOCHET_CORE_ANSWER_PLANAR_OUTCOME_H_

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "core/answer/outcome_parts.h"
#include "core/contact/reduction.h"
#include "core/models/planar/planar.h"
#include "ricochet/outcome.h"
#include "ricochet/scene.h"

namespace ricochet::planar {

// `problem` must be that of `reduction`.
// Errors: OUT_OF_RANGE names the first output that exceeds the largest double; INVALID_ARGUMENT for each
// history_at_n_s that is not in [0, tau1].
absl::StatusOr<Outcome> MakeOutcome(const Problem& problem, const PlanarReduction& reduction,
                                    absl::Span<const double> history_at_n_s, Detail detail = Detail::kAll);

}  // namespace ricochet::planar

#endif  // RICOCHET_CORE_ANSWER_PLANAR_OUTCOME_H_
