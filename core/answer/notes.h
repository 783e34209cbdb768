// AddNotes: what a caller should know about an answer and cannot read off its numbers.
//
// The duration of a contact with a normal spring is left out wherever velocities and impulses do not depend on it, and
// an angle beyond a full turn is taken as it is, although it may be meant in degrees. A rigid impact whose W has less
// than full rank may be undetermined: friction and the joints hold the contact with a velocity that does not end the
// impact, so that it has no answer, or part of the impulse of friction changes no velocity, so that any share of it
// within the cone of friction is possible. docs/theory/planar.md and docs/theory/spatial.md derive both. An answer
// about which there is nothing to say costs no allocation.

#ifndef RICOCHET_CORE_ANSWER_NOTES_H_
#define RICOCHET_CORE_ANSWER_NOTES_H_

#include "core/plan/planned_scene.h"
#include "ricochet/outcome.h"
#include "ricochet/scene.h"

namespace ricochet {

// The scene is valid, `planned` is its plan, and the outcome is complete but for its notes. Notes are in the order of
// their kinds and fields.
void AddNotes(const Scene& scene, const PlannedScene& planned, Outcome& outcome);

}  // namespace ricochet

#endif  // RICOCHET_CORE_ANSWER_NOTES_H_
