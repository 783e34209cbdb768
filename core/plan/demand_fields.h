// Turns what a request says of accuracy and effects into a Demand, and checks it.

#ifndef RICOCHET_CORE_PLAN_DEMAND_FIELDS_H_
#define RICOCHET_CORE_PLAN_DEMAND_FIELDS_H_

#include <vector>

#include "core/plan/demand.h"
#include "ricochet/demand.h"
#include "ricochet/error.h"
#include "ricochet/scene.h"

namespace ricochet {

Demand ToDemand(const DemandFields& fields);

// Every reason why the demand cannot be met for a valid scene, by path: "relative_tolerance", "required[1]".
std::vector<Violation> CheckDemand(const Scene& scene, const DemandFields& fields);

}  // namespace ricochet

#endif  // RICOCHET_CORE_PLAN_DEMAND_FIELDS_H_
