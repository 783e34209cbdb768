// Validate: checks every rule that a request about several contacts must keep, and lists all violations at once. All
// other code about several contacts relies on a valid request.

#ifndef RICOCHET_CORE_SCENE_VALIDATE_MULTI_H_
#define RICOCHET_CORE_SCENE_VALIDATE_MULTI_H_

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/contact/multi_reduction.h"
#include "ricochet/error.h"
#include "ricochet/multi_contact.h"

namespace ricochet {

// Lists the violations of the rules in ricochet/multi_contact.h, until the list is full. Paths start at the scene or at
// the request: "contacts[0].friction", "free_bodies.bodies[1].mass_kg", "methods[0]". Where there is none, `reduction`
// is what the scene was reduced to.
std::vector<Violation> Validate(const MultiContactRequest& request, std::optional<MultiReduction>& reduction);

inline constexpr std::array kMultiContactMethods = {MultiContactMethod::kOrders, MultiContactMethod::kSprings,
                                                    MultiContactMethod::kPossible};

// The name of a method: "orders".
const char* NameOf(MultiContactMethod method);

// Says why a scene cannot be answered by a method; empty if it can.
std::string WhyNot(MultiContactMethod method, int directions, int contacts);

}  // namespace ricochet

#endif  // RICOCHET_CORE_SCENE_VALIDATE_MULTI_H_
