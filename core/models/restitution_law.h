// The law of restitution: which of the three coefficients of restitution a scene states.
//
// Newton's is the ratio of the normal velocities, Poisson's that of the normal impulses, the energetic one (Stronge's)
// the root of the ratio of the normal works, each of restitution over compression.
// Source: Lubarda (2009), Eqs. [10], [14] and [19].

#ifndef RICOCHET_CORE_MODELS_RESTITUTION_LAW_H_
#define RICOCHET_CORE_MODELS_RESTITUTION_LAW_H_

#include "ricochet/scene.h"

namespace ricochet {

enum class RestitutionLaw { kNewton, kPoisson, kEnergetic };

// A restitution with its coefficient, free of units and >= 0.
struct StatedRestitution {
  RestitutionLaw law = RestitutionLaw::kEnergetic;
  double coefficient = 0.0;
};

// A restitution that is not set, as bounds allow, counts as energetic and 0.
StatedRestitution StatedBy(const Restitution& restitution);

}  // namespace ricochet

#endif  // RICOCHET_CORE_MODELS_RESTITUTION_LAW_H_
