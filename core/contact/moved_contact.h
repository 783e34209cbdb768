// ContactVelocityAt: the velocity of the contact of a system that moves at the rates given, and the sizes of its terms.

#ifndef RICOCHET_CORE_CONTACT_MOVED_CONTACT_H_
#define RICOCHET_CORE_CONTACT_MOVED_CONTACT_H_

#include "absl/types/span.h"
#include "ricochet/outcome.h"
#include "ricochet/scene.h"

namespace ricochet {

// The velocity is relative to the surface. The rates are all velocities of the system, in the order of
// SystemVelocityPaths; a contact alone has none.
ContactVelocity ContactVelocityAt(Scene scene, absl::Span<const double> rates);

// Returns, for each direction, the sum of the magnitudes of the terms that this velocity is the sum of: what each rate
// and the surface add to it. The velocity is rounded by some ulp of these, although it may be much smaller.
ContactVelocity SizeOfTerms(const Scene& scene, absl::Span<const double> rates);

}  // namespace ricochet

#endif  // RICOCHET_CORE_CONTACT_MOVED_CONTACT_H_
