// Slide: one section in which the particle slides, as algebra in the normal impulse (docs/theory/compliant.md,
// "Slide").

#ifndef RICOCHET_CORE_MODELS_COMPLIANT_SLIDE_H_
#define RICOCHET_CORE_MODELS_COMPLIANT_SLIDE_H_

#include "core/models/compliant/path_error.h"
#include "core/models/compliant/section.h"

namespace ricochet::compliant {

// Takes `state` and `error` to the end of the section. `mode.slip_side` is 1 or -1.
SectionEnd Slide(const SpringContact& contact, const SectionMode& mode, PathError& error, ContactState& state);

}  // namespace ricochet::compliant

#endif  // RICOCHET_CORE_MODELS_COMPLIANT_SLIDE_H_
