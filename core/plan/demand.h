// Demand: how exact an answer is to be, and what the caller decides about effects.

#ifndef RICOCHET_CORE_PLAN_DEMAND_H_
#define RICOCHET_CORE_PLAN_DEMAND_H_

#include <optional>
#include <vector>

#include "core/plan/plan.h"

namespace ricochet {

inline constexpr double kDefaultTolerance = 1e-12;
inline constexpr double kMostTolerance = 0.1;

struct Demand {
  // Error of each contact velocity after the impact over max(|u0|, |v0|). In [0, kMostTolerance]; 0 leaves out only what
  // changes nothing; absent means kDefaultTolerance.
  std::optional<double> relative_tolerance;
  std::vector<Effect> required;  // Simulated even if negligible. The scene has them.
  std::vector<Effect> excluded;  // Left out whatever that changes.
  friend bool operator==(const Demand&, const Demand&) = default;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_PLAN_DEMAND_H_
