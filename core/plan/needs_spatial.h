// NeedsSpatial: whether a contact in space surely needs the spatial model, at a fraction of the cost of ChooseSpatial.
//
// For a demand that is a tolerance alone, the spatial model is chosen if both friction and the turn of slip are too
// large to be left out. Lower bounds on their sizes decide this for nearly every contact; docs/theory/plan.md,
// section 7, derives them.

#ifndef RICOCHET_CORE_PLAN_NEEDS_SPATIAL_H_
#define RICOCHET_CORE_PLAN_NEEDS_SPATIAL_H_

#include "core/models/spatial/spatial.h"

namespace ricochet {

// True only if ChooseSpatial (core/plan/choose.h) chooses kSpatial for the problem, which must be valid, and a demand
// that is this tolerance alone. It then leaves out nothing.
bool NeedsSpatial(const spatial::Problem& problem, double tolerance);

}  // namespace ricochet

#endif  // RICOCHET_CORE_PLAN_NEEDS_SPATIAL_H_
