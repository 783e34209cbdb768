// ModelsOfPlanar: the models that ChoosePlanar (core/plan/choose.h) picks for many rigid planar contacts, in SIMD
// lanes.
//
// A demand that is a tolerance alone leaves four answers: none for a contact that separates, frictionless, sliding, and
// planar. Each follows from comparisons of sizes and errors with the tolerance. Cheap lower and upper bounds on both
// decide nearly every comparison; docs/theory/plan.md, section 7, derives them. Where they do not, or where a number is
// not surely valid, the answer is kUnspecified, and the contact has to be checked and asked for alone.

#ifndef RICOCHET_CORE_PLAN_PLANAR_MODELS_H_
#define RICOCHET_CORE_PLAN_PLANAR_MODELS_H_

#include "absl/types/span.h"
#include "core/models/planar_outputs.h"
#include "ricochet/plan.h"

namespace ricochet {

// The numbers may be anything. A model other than kUnspecified is given only to a contact that is valid, has a W of
// full rank, and whose numbers other than 0 have magnitudes in [2^-100, 2^100]. `models` is as long as the problems
// are.
void ModelsOfPlanar(const PlanarProblemColumns& problems, double tolerance, absl::Span<Model> models);

}  // namespace ricochet

#endif  // RICOCHET_CORE_PLAN_PLANAR_MODELS_H_
