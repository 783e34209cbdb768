// Columns: many planar impacts whose path is a straight line at once, in SIMD lanes, and only the outputs asked for.
//
// The problems meet the conditions of core/models/sliding/sliding.h, and each output has the bits that sliding::Solve
// or sliding::SolveFrictionless gives. No result depends on the other problems of the call. Nothing is allocated, and
// calls may run in parallel.

#ifndef RICOCHET_CORE_MODELS_SLIDING_COLUMNS_H_
#define RICOCHET_CORE_MODELS_SLIDING_COLUMNS_H_

#include "core/models/planar_outputs.h"

namespace ricochet::sliding {

// Neither reads `mu_static`. kRelativeError, which is the plan's to bound, may not be among the outputs.
void SolveColumns(const PlanarProblemColumns& problems, const PlanarSolvedColumns& solved);
// Reads neither `mu` nor `wtt`.
void SolveFrictionlessColumns(const PlanarProblemColumns& problems, const PlanarSolvedColumns& solved);

}  // namespace ricochet::sliding

#endif  // RICOCHET_CORE_MODELS_SLIDING_COLUMNS_H_
