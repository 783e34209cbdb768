// SolveScene: the impact of any scene, by the model that it calls for.
//
//   a pendulum that strikes a surface at rest   closed form             core/models/pendulum.h
//   a scene with an impact law                  that law                core/laws/impact_laws.h
//   any other planar system                     exact, event by event   core/models/planar.h
//   a system in space                           integrated              core/models/spatial.h

#ifndef RICOCHET_CORE_MODELS_SCENE_OUTCOME_H_
#define RICOCHET_CORE_MODELS_SCENE_OUTCOME_H_

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "core/models/outcome_parts.h"
#include "core/models/pendulum.h"
#include "core/outcome.h"
#include "core/scene/scene.h"
#include "core/solver.h"

namespace ricochet {

struct SolveOptions {
  absl::Span<const double> history_at_n_s;
  double tolerance = kDefaultTolerance;
  Detail detail = Detail::kAll;
};

// `scene` is valid.
// Errors: those of the models' MakeOutcome; OUT_OF_RANGE if W or the contact velocity exceeds the largest double.
absl::StatusOr<Outcome> SolveScene(const Scene& scene, const SolveOptions& options);

// OUT_OF_RANGE: W or the contact velocity exceeds the largest double.
absl::Status ContactOverflow();

// Whether the closed form of the pendulum answers the scene.
bool HasClosedForm(const Scene& scene);

// The closed form's problem with the coefficients at the approach speed. `scene` is valid and HasClosedForm.
pendulum::Problem ClosedFormProblem(const Scene& scene);

}  // namespace ricochet

#endif  // RICOCHET_CORE_MODELS_SCENE_OUTCOME_H_
