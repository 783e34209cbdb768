// Stick: one section in which the particle sticks, as two sinusoids in time (docs/theory/compliant.md, "Stick").

#ifndef RICOCHET_CORE_MODELS_COMPLIANT_STICK_H_
#define RICOCHET_CORE_MODELS_COMPLIANT_STICK_H_

#include "core/models/compliant/path_error.h"
#include "core/models/compliant/section.h"

namespace ricochet::compliant {

// Takes `state` and `error` to the end of the section. `mode.slip_side` is 0.
SectionEnd Stick(const SpringContact& contact, const SectionMode& mode, PathError& error, ContactState& state);

// Says whether friction provably holds the contact for ever: W has rank one, and the one oscillation that is left stays
// inside the friction cone and below the largest indentation.
bool IsHeldForEver(const SpringContact& contact, const SectionMode& mode, const ContactState& state);

}  // namespace ricochet::compliant

#endif  // RICOCHET_CORE_MODELS_COMPLIANT_STICK_H_
