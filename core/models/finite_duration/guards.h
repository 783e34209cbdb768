// Guards: the event functions of a mode, and the state of friction that follows where one has fallen. A mode lasts
// while its guards are >= 0.
//
// A turning point of a force is watched, too, because its peak lies there.

#ifndef RICOCHET_CORE_MODELS_FINITE_DURATION_GUARDS_H_
#define RICOCHET_CORE_MODELS_FINITE_DURATION_GUARDS_H_

#include <array>
#include <cstddef>

#include "core/models/finite_duration/motion.h"

namespace ricochet::finite_duration {

// The first kModeGuards end the mode where they fall below 0.
enum Guard : size_t {
  kReversal,   // v is about to change sign.
  kBranchEnd,  // Unloading: the spring is free. Reloading: d_max is reached again.
  kTension,    // Hunt and Crossley: N is about to pull.
  kUpper,      // Slip, the particle's slip, or the upper side of the friction cone.
  kLower,      // The lower side of the friction cone.
  kModeGuards,
  kForceExtreme = kModeGuards,  // It is 0 where N, or the force of the tangential spring, has an extreme.
  kGuards
};
using Guards = std::array<double, kGuards>;

// A guard that does not apply is 1.
Guards GuardsAt(const ScaledContact& contact, const Mode& mode, const Motion& y);

FrictionState FrictionAtStart(const ScaledContact& contact);
// The state of a tangentially rigid contact whose slip is 0, under the normal force `normal`.
FrictionState FrictionAtRest(const ScaledContact& contact, double normal);
// The state after kUpper or kLower has fallen; that of `mode` if it goes on.
FrictionState FrictionAfter(const ScaledContact& contact, const Mode& mode, const Motion& y, Guard fallen);
// Says whether v < 0 lasts for ever, which is so only if forces press a contact of rank one that friction holds.
bool NeverReverses(const ScaledContact& contact, const Mode& mode, const Motion& y);

}  // namespace ricochet::finite_duration

#endif  // RICOCHET_CORE_MODELS_FINITE_DURATION_GUARDS_H_
