// DemandFields: what a request says of accuracy and effects, unchecked.

#ifndef RICOCHET_CORE_PLAN_DEMAND_FIELDS_H_
#define RICOCHET_CORE_PLAN_DEMAND_FIELDS_H_

#include <optional>
#include <vector>

#include "core/error.h"
#include "core/plan/demand.h"
#include "core/plan/plan.h"
#include "core/scene/scene.h"

namespace ricochet {

struct DemandFields {
  std::optional<double> relative_tolerance;  // Absent means that of Demand.
  std::vector<Effect> required;              // In any order, each at most once.
  std::vector<Effect> excluded;
  friend bool operator==(const DemandFields&, const DemandFields&) = default;
};

Demand ToDemand(const DemandFields& fields);

// Every reason why the demand cannot be met for a valid scene, by path: "relative_tolerance", "required[1]".
std::vector<Violation> CheckDemand(const Scene& scene, const DemandFields& fields);

}  // namespace ricochet

#endif  // RICOCHET_CORE_PLAN_DEMAND_FIELDS_H_
