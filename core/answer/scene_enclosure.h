// EncloseScene: the range of each coefficient over an uncertain scene, proved to contain it.
//
//   a pendulum with ranges of its own fields and of friction   at the corners of the box
//   any other planar system                                    branch and bound (core/bounds/enclosure.h)
//
// Any field that an axis of a sweep can drive (core/scene/field.h) may have a range, with three exceptions. Bounds hold
// for every coefficient of restitution. The numbers of friction.by_speed count as they stand; friction's factor is
// enclosed over the approach speeds of the box. If W has rank one by construction (a pendulum, a linkage of one link),
// the surface must be at rest, because the enclosure covers velocities in the range of W.
// Units are those of the fields. Bad input: see CheckRanges and EncloseScene.

#ifndef RICOCHET_CORE_ANSWER_SCENE_ENCLOSURE_H_
#define RICOCHET_CORE_ANSWER_SCENE_ENCLOSURE_H_

#include <cstdint>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "ricochet/bounds.h"
#include "ricochet/error.h"
#include "ricochet/scene.h"
#include "ricochet/solver.h"

namespace ricochet {

// Lists what is wrong with the ranges for this scene; `scene` need not be valid.
std::vector<Violation> CheckRanges(const Scene& scene, absl::Span<const FieldRange> ranges);

// Encloses all scenes that differ from `scene` only in fields within the ranges. `scene` is valid and CheckRanges finds
// nothing. At most `most_boxes` boxes are evaluated, and never more than 200,000: an answer that would take more is
// wider than it could be, and its excess says by how much. `stopped` is asked before each box of scenes. Errors:
// INVALID_ARGUMENT naming `ranges` if no scene of the box is valid; INVALID_ARGUMENT naming the system if the W of all
// its scenes has rank one though others of its kind have rank two, because the enclosure covers velocities in the range
// of W; CANCELLED once `stopped` says true.
absl::StatusOr<Enclosure> EncloseScene(const Scene& scene, absl::Span<const FieldRange> ranges, int64_t most_boxes,
                                       absl::FunctionRef<bool()> stopped);

}  // namespace ricochet

#endif  // RICOCHET_CORE_ANSWER_SCENE_ENCLOSURE_H_
