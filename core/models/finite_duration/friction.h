// Friction: which state follows where slip, or the speed of the particle, has come to 0, and where a stick breaks.

#ifndef RICOCHET_CORE_MODELS_FINITE_DURATION_FRICTION_H_
#define RICOCHET_CORE_MODELS_FINITE_DURATION_FRICTION_H_

#include "core/models/finite_duration/guards.h"

namespace ricochet::finite_duration {

FrictionState FrictionAtStart(const ScaledContact& contact);
// The state of a tangentially rigid contact whose slip is 0, under the normal force `normal`.
FrictionState FrictionAtRest(const ScaledContact& contact, double normal);
// The state after kUpper or kLower has fallen; that of `mode` if it goes on.
FrictionState FrictionAfter(const ScaledContact& contact, const Mode& mode, const Motion& y, Guard fallen);
// Says whether v < 0 lasts for ever, which is so only if forces press a contact of rank one that friction holds.
bool NeverReverses(const ScaledContact& contact, const Mode& mode, const Motion& y);

}  // namespace ricochet::finite_duration

#endif  // RICOCHET_CORE_MODELS_FINITE_DURATION_FRICTION_H_
