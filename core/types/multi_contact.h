// Says whether an outcome of several contacts has an end, and names the numbers of an answer, in their order.

#ifndef RICOCHET_CORE_TYPES_MULTI_CONTACT_H_
#define RICOCHET_CORE_TYPES_MULTI_CONTACT_H_

#include <cstddef>
#include <string>
#include <vector>

#include "ricochet/multi_contact.h"

namespace ricochet {

// False if the end is not known, so that the numbers are those of a state on the way to it.
constexpr bool HasEnd(MultiContactEnd end) {
  return end != MultiContactEnd::kBudgetUsedUp && end != MultiContactEnd::kUndetermined;
}

// Returns "contact_1.t", "contact_1.n", ... in a plane; in space t1, t2 and n take the place of t and n.
std::vector<std::string> ContactOutputNames(size_t contacts, int directions);

// Returns "body_1.x", "body_1.y", "body_1.rate", ..., in space x, y, z, rate_x, rate_y, rate_z; "rate_1", ... for a
// mechanism; and nothing for a ContactMatrix, whose only velocities are those of its contacts.
std::vector<std::string> SystemOutputNames(const MultiContactSystem& system, int directions);

}  // namespace ricochet

#endif  // RICOCHET_CORE_TYPES_MULTI_CONTACT_H_
