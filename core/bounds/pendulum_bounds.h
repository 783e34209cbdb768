// SolveBounds: the bounds of the pendulum's coefficients, [27]-[31], [54], [55]; ricochet/bounds.h has the formulas.
//
// Accuracy: 1 ulp, but an upper bound of `sharp` that rounding would push past what Solve accepts as admissible is the
// next double below. -(a/|b|)(1 - sqrt(1 - x^2)) is computed as -mu x/(1 + sqrt(1 - x^2)), in which nothing cancels
// near x = 0; near x = 1 the code uses 1 - x^2 = (1 - x)(1 + x). Bad input: none gets here (core/scene/validate.h).

#ifndef RICOCHET_CORE_BOUNDS_PENDULUM_BOUNDS_H_
#define RICOCHET_CORE_BOUNDS_PENDULUM_BOUNDS_H_

#include "core/models/pendulum/pendulum.h"
#include "ricochet/bounds.h"

namespace ricochet::pendulum {

// `problem.coefficient` is not used.
Bounds SolveBounds(const Problem& problem);

}  // namespace ricochet::pendulum

#endif  // RICOCHET_CORE_BOUNDS_PENDULUM_BOUNDS_H_
