// SolveScene: the impact of any scene, by the model that its plan has chosen (core/plan/).

#ifndef RICOCHET_CORE_ANSWER_SCENE_OUTCOME_H_
#define RICOCHET_CORE_ANSWER_SCENE_OUTCOME_H_

#include <optional>

#include "absl/functional/function_ref.h"
#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/answer/outcome_parts.h"
#include "core/contact/scene_contact.h"
#include "core/plan/demand.h"
#include "core/plan/planned_scene.h"
#include "ricochet/outcome.h"
#include "ricochet/plan.h"
#include "ricochet/scene.h"

namespace ricochet {

// Solves a valid scene in which CheckDemand finds nothing, into an outcome that is empty. `contact` is set if it was
// not yet and the scene needs it. With Detail::kNumbers the outcome's plan has the model alone. Errors are those of the
// models' MakeOutcome, and ContactOverflow.
//
// An impact that takes time asks `stopped` every few steps and ends soon after it says true, with CANCELLED.
absl::Status SolveScene(const Scene& scene, std::optional<SceneContact>& contact, const Demand& demand,
                        const OutcomeDetail& detail, absl::FunctionRef<bool()> stopped, Outcome& outcome);

// Sets the outcome's free_end. The scene states a mechanism that holds some coordinates.
// Errors: those of SolveScene, and INVALID_ARGUMENT where a coefficient breaks its rule at the speed of the free end.
absl::Status SetFreeEnd(const Scene& scene, const Demand& demand, absl::FunctionRef<bool()> stopped, Outcome& outcome);

// The second half of SolveScene, for a scene that PlanScene has planned.
absl::Status SolvePlanned(const Scene& scene, const std::optional<SceneContact>& contact, const PlannedScene& planned,
                          const OutcomeDetail& detail, absl::FunctionRef<bool()> stopped, Outcome& outcome);

// Plans such a scene without computing it.
// Errors: ContactOverflow.
absl::StatusOr<Plan> PlanOf(const Scene& scene, std::optional<SceneContact>& contact, const Demand& demand);

// OUT_OF_RANGE: W or the contact velocity exceeds the largest double, or W_nn is below the smallest.
absl::Status ContactOverflow();

}  // namespace ricochet

#endif  // RICOCHET_CORE_ANSWER_SCENE_OUTCOME_H_
