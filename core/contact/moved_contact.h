// ContactVelocityAt: the velocity of the contact of a system that moves at the rates given.

#ifndef RICOCHET_CORE_CONTACT_MOVED_CONTACT_H_
#define RICOCHET_CORE_CONTACT_MOVED_CONTACT_H_

#include "absl/types/span.h"
#include "ricochet/outcome.h"
#include "ricochet/scene.h"

namespace ricochet {

// The velocity is relative to the surface. The rates are those of a pendulum, of the links of a linkage, of a
// mechanism, or of bodies in a plane, which have their linear velocity before their angular one: all that the system
// has, in the order in which an outcome lists them. Other systems have no such rates.
ContactVelocity ContactVelocityAt(Scene scene, absl::Span<const double> rates);

}  // namespace ricochet

#endif  // RICOCHET_CORE_CONTACT_MOVED_CONTACT_H_
