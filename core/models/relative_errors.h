// RelativeErrors: proved bounds on the error of a model's answer, all divided by V = max(|u0|, |v0|).

#ifndef RICOCHET_CORE_MODELS_RELATIVE_ERRORS_H_
#define RICOCHET_CORE_MODELS_RELATIVE_ERRORS_H_

#include <algorithm>

namespace ricochet {

struct RelativeErrors {
  double velocity = 0.0;  // Error of each component of the contact velocity after the impact.
  // Error of each impulse times its mobility: Wnn |d tau1|, Wtt |d f1|; in space (W11 + W22) |d f1| for each component.
  double impulse = 0.0;

  double Largest() const { return std::max(velocity, impulse); }
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_MODELS_RELATIVE_ERRORS_H_
