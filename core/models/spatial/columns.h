// Columns: many impacts in space at once, in SIMD lanes, each with the bits of Solve.
//
// No impact depends on the others of the call. Nothing is allocated, and calls may run in parallel.
// docs/theory/spatial.md says how impacts of different lengths share the lanes.

#ifndef RICOCHET_CORE_MODELS_SPATIAL_COLUMNS_H_
#define RICOCHET_CORE_MODELS_SPATIAL_COLUMNS_H_

#include "absl/types/span.h"
#include "core/models/spatial/spatial.h"

namespace ricochet::spatial {

// Solves every problem into the impact at its place. The problems are valid, as that of Solve is.
void SolveColumns(absl::Span<const Problem> problems, absl::Span<Impact> impacts);

}  // namespace ricochet::spatial

#endif  // RICOCHET_CORE_MODELS_SPATIAL_COLUMNS_H_
