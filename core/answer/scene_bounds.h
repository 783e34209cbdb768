// SolveSceneBounds: the bounds of any scene.
//
//   a pendulum over a surface at rest   closed form                           core/bounds/pendulum_bounds.h
//   any other planar system             ends of the path's restitution        core/bounds/contact_bounds.h
//   a system in space                   a sample of impacts, Bounds::sampled
//
// In space the path does not depend on restitution either, but slip that turns can press the bodies together again, and
// friction's share of the impulse may turn anywhere on the way: nothing proves that the ends are the extremes. What is
// answered is the hull of kSpatialImpacts impacts, the energetic coefficient at equal steps from 0 to 1, each solved to
// spatial::kStudyTolerance: it lies within the true range, to that tolerance. There are no bounds by energy alone and
// no critical coefficients.

#ifndef RICOCHET_CORE_ANSWER_SCENE_BOUNDS_H_
#define RICOCHET_CORE_ANSWER_SCENE_BOUNDS_H_

#include "absl/status/statusor.h"
#include "ricochet/bounds.h"
#include "ricochet/scene.h"

namespace ricochet {

inline constexpr int kSpatialImpacts = 65;

// `scene` is valid, its restitution set or not, and has no impact law.
// Errors: OUT_OF_RANGE if W, the contact velocity or a bound, which is named, exceeds the largest double, or W_nn is
// below the smallest, or where an impact of a sample does not end.
absl::StatusOr<Bounds> SolveSceneBounds(const Scene& scene);

}  // namespace ricochet

#endif  // RICOCHET_CORE_ANSWER_SCENE_BOUNDS_H_
