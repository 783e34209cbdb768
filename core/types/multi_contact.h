// Whether an outcome of several contacts has an end, and the names of the numbers of an answer, in their order.

#ifndef RICOCHET_CORE_TYPES_MULTI_CONTACT_H_
#define RICOCHET_CORE_TYPES_MULTI_CONTACT_H_

#include <cstddef>
#include <string>
#include <vector>

#include "ricochet/multi_contact.h"

namespace ricochet {

// True unless the numbers are those of a state on the way to an end that is not known.
constexpr bool HasEnd(MultiContactEnd end) {
  return end != MultiContactEnd::kBudgetUsedUp && end != MultiContactEnd::kUndetermined;
}

// "contact_1.t", "contact_1.n", ... or t1, t2 and n.
std::vector<std::string> ContactOutputNames(size_t contacts, int directions);

// "body_1.x", "body_1.y", "body_1.rate", ... or x, y, z, rate_x, rate_y, rate_z; "rate_1", ... of a mechanism. None of
// a ContactMatrix, whose velocities are those of its contacts.
std::vector<std::string> SystemOutputNames(const MultiContactSystem& system, int directions);

}  // namespace ricochet

#endif  // RICOCHET_CORE_TYPES_MULTI_CONTACT_H_
