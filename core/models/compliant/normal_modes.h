// NormalModes: the two oscillations of a compliant contact whose particle sticks.
//
// y = (ratio p, N/sqrt(kn)) obeys y'' = -K y with a symmetric K (docs/theory/compliant.md, "Stick"). Its eigenvectors
// are (c, s) and (-s, c), the squares of the frequencies its eigenvalues.

#ifndef RICOCHET_CORE_MODELS_COMPLIANT_NORMAL_MODES_H_
#define RICOCHET_CORE_MODELS_COMPLIANT_NORMAL_MODES_H_

#include <array>

#include "core/models/compliant/oscillation.h"
#include "core/models/compliant/section.h"

namespace ricochet::compliant {

// The components along the eigenvectors, and their rates.
struct Oscillations {
  std::array<double, 2> y = {}, rate = {};
};

struct NormalModes {
  Frequencies w;
  double c = 1.0, s = 0.0;
  std::array<double, 2> y = {}, rate = {};  // Components along the eigenvectors at the start, and their rates.

  // The oscillations at the time of `phase`.
  Oscillations At(const Phase& phase) const;
  // The signal first y_0(t) + second y_1(t).
  Signal Combination(double first, double second) const;
};

NormalModes MakeNormalModes(const SpringContact& contact, const SectionMode& mode, const ContactState& state);

// N(t).
Signal NormalForce(const SpringContact& contact, const SectionMode& mode, const NormalModes& modes);
// mu N(t) - side p(t): the particle stays stuck on this side while it is positive.
Signal ConeMargin(const SpringContact& contact, const SectionMode& mode, const NormalModes& modes, int side);
// |v(t)|, signed so that it is positive until v changes its sign.
Signal NormalSpeed(const SpringContact& contact, const SectionMode& mode, const NormalModes& modes);

}  // namespace ricochet::compliant

#endif  // RICOCHET_CORE_MODELS_COMPLIANT_NORMAL_MODES_H_
