// SolveBounds: the ranges of the coefficients of a planar contact as its energetic coefficient runs from 0 to 1.
//
// The path of the impact does not depend on restitution, so every number is monotone in where restitution ends, and the
// plastic and the elastic impact give the ends of all ranges. `energy_only` holds what kinetic energy alone allows, and
// `critical` the coefficients of friction at which the impact changes its course (Wang and Mason 1992).
// docs/theory/bounds.md has the derivation. Units are those of core/models/planar/planar.h.
//
// Accuracy: `sharp` has the accuracy of planar::Solve, but an upper bound that rounding would push past what Solve
// accepts as admissible is a few doubles lower. `energy_only` and `critical` lose what their formulas cancel, some 8
// ulp of the largest term. Bad input: none gets here (core/scene/validate.h).

#ifndef RICOCHET_CORE_BOUNDS_CONTACT_BOUNDS_H_
#define RICOCHET_CORE_BOUNDS_CONTACT_BOUNDS_H_

#include "core/models/planar/planar.h"
#include "ricochet/bounds.h"

namespace ricochet::planar {

// `problem.law` and `problem.coefficient` are not used. The regime is that of the elastic impact, which passes every
// event of the others. If the contact separates, all ranges are 0.
Bounds SolveBounds(const Problem& problem);

}  // namespace ricochet::planar

#endif  // RICOCHET_CORE_BOUNDS_CONTACT_BOUNDS_H_
