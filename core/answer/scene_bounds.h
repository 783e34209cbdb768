// SolveSceneBounds: the bounds of any scene.
//
//   a pendulum over a surface at rest   closed form                              core/bounds/pendulum_bounds.h
//   any other planar system             plastic and elastic end of the path      core/bounds/contact_bounds.h
//   a system in space                   hull of a sample of kSpatialImpacts impacts, Bounds::sampled
//
// The sample's energetic coefficients lie at equal steps from 0 to 1, and at both sides of the coefficient where the
// outcome jumps because the end of the impact recedes. Each impact is solved to spatial::kStudyTolerance. The hull lies
// within the true range, to that tolerance; docs/theory/bounds.md says why no more is known in space, and why there are
// no bounds by energy alone and no critical coefficients. Units are those of ricochet/bounds.h.

#ifndef RICOCHET_CORE_ANSWER_SCENE_BOUNDS_H_
#define RICOCHET_CORE_ANSWER_SCENE_BOUNDS_H_

#include <optional>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "core/contact/scene_contact.h"
#include "ricochet/bounds.h"
#include "ricochet/scene.h"

namespace ricochet {

inline constexpr int kSpatialImpacts = 65;

// `scene` is valid, its restitution set or not, and has no impact law. `stopped` is asked before each impact of a
// sample. Errors: OUT_OF_RANGE if W, the contact velocity or a bound, which is named, exceeds the largest double, if
// W_nn is below the smallest normal one, or if an impact of a sample does not end; CANCELLED once `stopped` says true.
absl::StatusOr<Bounds> SolveSceneBounds(const Scene& scene, std::optional<SceneContact> contact,
                                        absl::FunctionRef<bool()> stopped);

}  // namespace ricochet

#endif  // RICOCHET_CORE_ANSWER_SCENE_BOUNDS_H_
