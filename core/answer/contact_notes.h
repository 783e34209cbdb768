// Contact notes: what an outcome of rigid contact cannot know of its impact because W has less than full rank.
//
// Notes of kind kUndetermined say where friction and the joints hold the contact with a velocity that does not end the
// impact, so that it has no answer, and where part of the impulse of friction changes no velocity, so that any share of it
// within the cone of friction is possible. docs/theory/planar.md and docs/theory/spatial.md derive both.

#ifndef RICOCHET_CORE_ANSWER_CONTACT_NOTES_H_
#define RICOCHET_CORE_ANSWER_CONTACT_NOTES_H_

#include "core/contact/reduction.h"
#include "ricochet/outcome.h"

namespace ricochet {

// Adds the notes to an outcome by a rigid model that is complete but for them. `effective` has the coefficients that the
// model has used.
void AddContactNotes(const PlanarReduction& reduction, const EffectiveCoefficients& effective, Outcome& outcome);
void AddContactNotes(const SpatialReduction& reduction, const EffectiveCoefficients& effective, Outcome& outcome);

// The note for a contact that friction does not move, and that does not slip.
void AddIdleFrictionNote(Outcome& outcome);

}  // namespace ricochet

#endif  // RICOCHET_CORE_ANSWER_CONTACT_NOTES_H_
