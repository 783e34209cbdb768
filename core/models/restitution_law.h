// The law of restitution: which of the three coefficients of restitution a scene states.
//
// Newton's coefficient is the ratio of the normal velocities after and before the impact, Poisson's the ratio of the
// normal impulses of restitution and compression, and the energetic one (Stronge's) the root of the ratio of the normal
// works of restitution and compression.
// Source: Lubarda (2009), Eqs. [10], [14] and [19].

#ifndef RICOCHET_CORE_MODELS_RESTITUTION_LAW_H_
#define RICOCHET_CORE_MODELS_RESTITUTION_LAW_H_

#include "ricochet/scene.h"

namespace ricochet {

enum class RestitutionLaw { kNewton, kPoisson, kEnergetic };

// A law of restitution with its coefficient, which has no unit and is >= 0.
struct StatedRestitution {
  RestitutionLaw law = RestitutionLaw::kEnergetic;
  double coefficient = 0.0;
};

// Bounds allow a restitution that is not set; it counts as energetic with the coefficient 0.
StatedRestitution LawAndCoefficientOf(const Restitution& restitution);

// The restitution that states this law and coefficient.
Restitution ToRestitution(RestitutionLaw law, double coefficient);

}  // namespace ricochet

#endif  // RICOCHET_CORE_MODELS_RESTITUTION_LAW_H_
