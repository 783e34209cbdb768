// FindSprings: the limit of stiff springs at the contacts of a plane, whose stiffnesses keep fixed ratios.
//
// Each contact has a spring of stiffness k that unloads with k/e^2, and a gap once it is open. The motion is followed
// mode by mode (core/multi/spring_flow.h). At an event the modes are those in which the first coefficient of every
// condition that is not zero has the right sign. With e = 0 a force falls at once, as e -> 0 has it. The path is unique
// and depends continuously on all numbers, and energy never rises. The error is a bound that is carried along the path;
// it is an estimate where it has grown too large, where a contact only grazes, where friction changes while a force
// falls, and where small coefficients end elsewhere than those that are 0.
// docs/theory/several_contacts.md derives all of it.
// Cost: some 20 us for two contacts, growing with the events and the cube of the contacts.

#ifndef RICOCHET_CORE_MULTI_SPRINGS_H_
#define RICOCHET_CORE_MULTI_SPRINGS_H_

#include <cstdint>
#include <optional>

#include "absl/functional/function_ref.h"
#include "core/multi/mirror.h"
#include "core/multi/problem.h"

namespace ricochet::multi {

// A motion that has not ended after this many events ends with kBudgetUsedUp.
inline constexpr int64_t kSpringsBudget = 20'000;

// Once `stopped` says true, the answer means nothing. The mirror is that of the problem, if it has one.
Attained FindSprings(const Problem& problem, const std::optional<Mirror>& mirror, absl::FunctionRef<bool()> stopped,
                     int64_t budget = kSpringsBudget);

}  // namespace ricochet::multi

#endif  // RICOCHET_CORE_MULTI_SPRINGS_H_
