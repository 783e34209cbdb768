// ToDemand and CheckDemand: convert what a request says of accuracy and effects into a Demand, and check it.

#ifndef RICOCHET_CORE_PLAN_DEMAND_FIELDS_H_
#define RICOCHET_CORE_PLAN_DEMAND_FIELDS_H_

#include <optional>
#include <vector>

#include "core/contact/scene_contact.h"
#include "core/plan/demand.h"
#include "ricochet/demand.h"
#include "ricochet/error.h"
#include "ricochet/scene.h"

namespace ricochet {

Demand ToDemand(const DemandFields& fields);

// Lists what is wrong with the demand whatever the scene, which may break its own rules.
std::vector<Violation> CheckDemand(const DemandFields& fields);

// Lists every reason why the demand cannot be met for a valid scene, with paths such as "relative_tolerance" and
// "required[1]".
std::vector<Violation> CheckDemand(const Scene& scene, std::optional<SceneContact>& contact,
                                   const DemandFields& fields);

}  // namespace ricochet

#endif  // RICOCHET_CORE_PLAN_DEMAND_FIELDS_H_
