// SolveScene: the impact of any scene, by the model that its plan has chosen (core/plan/).

#ifndef RICOCHET_CORE_ANSWER_SCENE_OUTCOME_H_
#define RICOCHET_CORE_ANSWER_SCENE_OUTCOME_H_

#include <cstdint>
#include <optional>

#include "absl/functional/function_ref.h"
#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "core/answer/outcome_parts.h"
#include "core/contact/scene_contact.h"
#include "core/plan/demand.h"
#include "ricochet/outcome.h"
#include "ricochet/scene.h"

namespace ricochet {

struct SolveOptions {
  absl::Span<const double> history_at_n_s;
  int64_t force_intervals = 0;
  Demand demand;
  Detail detail = Detail::kAll;
};

// Solves a valid scene in which CheckDemand finds nothing. With Detail::kNumbers the outcome's plan has the model alone.
// Errors are those of the models' MakeOutcome, and ContactOverflow.
//
// An impact that takes time asks `stopped` every few steps and ends soon after it says true, with CANCELLED.
absl::StatusOr<Outcome> SolveScene(const Scene& scene, std::optional<SceneContact> contact, const SolveOptions& options,
                                   absl::FunctionRef<bool()> stopped);

// The plan alone, in an outcome that has nothing else.
// Errors: OUT_OF_RANGE as above.
absl::StatusOr<Outcome> PlanSceneOnly(const Scene& scene, std::optional<SceneContact> contact, const Demand& demand);

// OUT_OF_RANGE: W or the contact velocity exceeds the largest double, or W_nn is below the smallest.
absl::Status ContactOverflow();

}  // namespace ricochet

#endif  // RICOCHET_CORE_ANSWER_SCENE_OUTCOME_H_
