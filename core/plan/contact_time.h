// LongestContact: a bound on the duration of an impact whose force of indentation is N = k d^p, under finite forces.
//
//   dv = A dtau + a dt,   A in [lo, hi], lo > 0,   d' = -v,   N = k d^p, p >= 1,   dtau = N dt,   v(0) = v0 < 0
//
// A may be any function with values in this range, such as Wnn + Wtn f' with |f'| <= m: lo = Wnn - m |Wtn| and
// hi = Wnn + m |Wtn|. a is the normal acceleration by the finite forces, and g >= |a|. Unloading returns eta^2 of the
// work. The bound holds if 6 g D* hi <= lo v0^2, where D* is a lower bound on the largest indentation;
// docs/theory/plan.md, section 6, derives both. There is no bound for eta = 0 under finite forces, nor for Hunt and
// Crossley's damping.

#ifndef RICOCHET_CORE_PLAN_CONTACT_TIME_H_
#define RICOCHET_CORE_PLAN_CONTACT_TIME_H_

#include "ricochet/scene.h"

namespace ricochet {

struct Indentation {
  double slope_low = 0.0;     // lo, 1/kg
  double slope_high = 0.0;    // hi
  double v0 = 0.0;            // m/s
  double energetic = 0.0;     // eta
  double acceleration = 0.0;  // g, m/s^2
};

// The bound T in s, enlarged by 2^-20 of itself; infinite if its condition fails.
double LongestContact(const NormalSpring& spring, const Indentation& of);

}  // namespace ricochet

#endif  // RICOCHET_CORE_PLAN_CONTACT_TIME_H_
