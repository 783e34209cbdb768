// An impact in space as an Outcome: contact velocities, ledger, timeline, limits broken, velocities of the system.

#ifndef RICOCHET_CORE_MODELS_SPATIAL_OUTCOME_H_
#define RICOCHET_CORE_MODELS_SPATIAL_OUTCOME_H_

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "core/models/outcome_parts.h"
#include "core/models/spatial.h"
#include "core/outcome.h"
#include "core/scene/reduction.h"
#include "core/scene/scene.h"

namespace ricochet::spatial {

// The impact of a reduced system. `effective` holds the coefficients, `restitution` says by which law.
Problem MakeProblem(const SpatialReduction& reduction, const Restitution& restitution,
                    const EffectiveCoefficients& effective, double tolerance);

// `problem` is of `reduction`. The path between events is not kept, so that there is no history.
// Errors: OUT_OF_RANGE naming the first output that exceeds the largest double; INVALID_ARGUMENT if
// `history_at_n_s` is not empty.
absl::StatusOr<Outcome> MakeOutcome(const Problem& problem, const SpatialReduction& reduction,
                                    absl::Span<const double> history_at_n_s, Detail detail = Detail::kAll);

}  // namespace ricochet::spatial

#endif  // RICOCHET_CORE_MODELS_SPATIAL_OUTCOME_H_
