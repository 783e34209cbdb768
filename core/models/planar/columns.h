// Columns: many planar impacts of one law of restitution at once, in SIMD lanes, and only the outputs asked for.
//
// Each output is that of the first arithmetic whose bound on its rounding error is within the tolerance: plain double
// arithmetic (SolvePlain), or double-double arithmetic (Solve), with the same bits. At tolerance 0 it is the latter. No
// result depends on the other problems of the call. Nothing is allocated, and calls may run in parallel.

#ifndef RICOCHET_CORE_MODELS_PLANAR_COLUMNS_H_
#define RICOCHET_CORE_MODELS_PLANAR_COLUMNS_H_

#include <array>
#include <cstddef>

#include "core/models/planar/planar.h"
#include "core/models/planar_outputs.h"

namespace ricochet::planar {

using Output = PlanarOutput;
inline constexpr int kOutputCount = kPlanarOutputCount;

// The problems are valid, as those of Solve are.
using ProblemColumns = PlanarProblemColumns;
using SolvedColumns = PlanarSolvedColumns;

// Every output of an impact, at the number of the output.
std::array<double, kOutputCount> NumbersOf(const ImpactEnd<double>& impact, double relative_error);

// The tolerance is in [0, 1) and means what RoundingErrors::Largest does, which is the output kRelativeError. Returns
// the number of problems for which plain arithmetic did not serve.
size_t SolveColumns(const ProblemColumns& problems, double tolerance, const SolvedColumns& solved);

}  // namespace ricochet::planar

#endif  // RICOCHET_CORE_MODELS_PLANAR_COLUMNS_H_
