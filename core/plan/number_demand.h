// NumberDemand: what asking for a number of an outcome asks of the plan. Asking for the number is asking for the
// effect that makes it.
//
// Most numbers are those of every model, and ask for nothing. The numbers of Outcome::contact are made by finite
// duration, which a plan leaves out wherever velocities and impulses do not depend on it. The columns of sweeps and
// batches and the force history of one impact come here, so that none of them shows a number that no model computed.

#ifndef RICOCHET_CORE_PLAN_NUMBER_DEMAND_H_
#define RICOCHET_CORE_PLAN_NUMBER_DEMAND_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/strings/string_view.h"
#include "absl/types/span.h"
#include "core/contact/scene_contact.h"
#include "core/plan/demand.h"
#include "ricochet/plan.h"
#include "ricochet/scene.h"

namespace ricochet {

// The effect that makes the number at `path`, "contact.duration_s"; none for a number of every model.
std::optional<Effect> EffectBehind(absl::string_view path);

// Requires the effect behind each number, besides those that the demand requires.
Demand WithNumbers(Demand demand, absl::Span<const std::string> paths);

// The part that the scene lacks for the number, so that no outcome of it has the number; empty if it lacks nothing.
std::string LackingForNumber(const Scene& scene, absl::string_view path);

// Lists why a valid scene and a demand in which CheckDemand finds nothing cannot give the number: "must not be asked of
// a scene without ...". The list is empty if they can.
std::vector<std::string> WhyNoNumber(const Scene& scene, std::optional<SceneContact>& contact, const Demand& demand,
                                     absl::string_view path);

}  // namespace ricochet

#endif  // RICOCHET_CORE_PLAN_NUMBER_DEMAND_H_
