// Conditions: what has to stay >= 0 for contacts on springs to keep their modes, as series in time.
//
// The modes of a flow (core/multi/spring_flow.h) hold while the first coefficient of each condition that is not zero is
// positive; the first zero of a condition is the next event.

#ifndef RICOCHET_CORE_MULTI_SPRING_CONDITIONS_H_
#define RICOCHET_CORE_MULTI_SPRING_CONDITIONS_H_

#include <bitset>
#include <optional>
#include <vector>

#include "core/multi/problem.h"
#include "core/multi/spring_flow.h"

namespace ricochet::multi {

// An event is found to within this part of the largest coefficient of its condition.
inline constexpr double kZeroOfEvent = 1e-10;

// The function that has to stay >= 0 for a contact to keep its mode.
enum class Keeps { kGap, kPressed, kApproaching, kParting, kSlip, kConeAbove, kConeBelow };
constexpr bool IsCone(Keeps keeps) { return keeps == Keeps::kConeAbove || keeps == Keeps::kConeBelow; }

struct Condition {
  int contact = 0;
  Keeps keeps = Keeps::kGap;
  Series series;
  int lead = 0;
};

// Event names the condition that is 0 because of the event at the present state, and the contacts for which it is 0.
struct Event {
  std::bitset<kMostContacts> contacts;
  Keeps keeps = Keeps::kGap;
  bool has_tie = false;  // No time has passed since the event before.
};

// The conditions of all contacts. A coefficient that the event has made 0 counts as 0.
std::vector<Condition> ConditionsOf(const Problem& problem, const Modes& modes, const SpringFlow& flow,
                                    const std::optional<Event>& event);

// True if a plastic contact stops approaching: its force falls at once.
bool Falls(const Condition& condition, const Problem& problem, const SpringState& state);

// Returns the condition that is broken at the lowest order, or null. Plastic contacts that stop approaching come last:
// their forces fall, and that changes the state.
const Condition* Broken(const std::vector<Condition>& conditions, const Problem& problem, const SpringState& state);

// Changes the mode of the contact that breaks the condition under this force.
void Change(const Condition& broken, double force, ContactMode& mode);

}  // namespace ricochet::multi

#endif  // RICOCHET_CORE_MULTI_SPRING_CONDITIONS_H_
