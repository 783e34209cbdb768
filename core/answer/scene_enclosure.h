// EncloseScene: the range of each coefficient over an uncertain scene, proved to contain it.
//
//   a pendulum, ranges of its own fields and friction's   at corners         core/bounds/enclosure.h, Enclose(PendulumBox)
//   any other planar system                               branch and bound   core/bounds/enclosure.h, over
//                                                                            core/contact/interval_reduction.h
//
// A range may be of whatever an axis of a sweep can drive (core/scene/field.h), but for the coefficients of
// restitution, which bounds do not depend on, and for the numbers of friction.by_speed, which count as they stand:
// friction's factor is enclosed over the approach speeds of the box. A system whose W has rank one by its nature, a
// pendulum or a linkage of one link, strikes a surface at rest; next to no other surface velocity is in the range of
// its W.
//
// Bad input: see CheckRanges and EncloseScene.

#ifndef RICOCHET_CORE_ANSWER_SCENE_ENCLOSURE_H_
#define RICOCHET_CORE_ANSWER_SCENE_ENCLOSURE_H_

#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "ricochet/bounds.h"
#include "ricochet/error.h"
#include "ricochet/scene.h"
#include "ricochet/solver.h"

namespace ricochet {

// What is wrong with the ranges for this scene; `scene` need not be valid.
std::vector<Violation> CheckRanges(const Scene& scene, absl::Span<const FieldRange> ranges);

// The enclosure over all scenes that differ from `scene` in fields within the ranges alone. `scene` is valid and
// CheckRanges finds nothing.
// Errors: INVALID_ARGUMENT naming `ranges` if no scene of the box is valid, and the system if the W of all its scenes
// has rank one though those of its kind do not: next to none of the velocities could be its. CANCELLED once `stopped`
// says so; it is asked every kBoxesUnasked boxes (core/bounds/enclosure.h).
absl::StatusOr<Enclosure> EncloseScene(const Scene& scene, absl::Span<const FieldRange> ranges,
                                       absl::FunctionRef<bool()> stopped);

}  // namespace ricochet

#endif  // RICOCHET_CORE_ANSWER_SCENE_ENCLOSURE_H_
