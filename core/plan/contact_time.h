// Contact time: a bound on how long an impact lasts whose force of indentation is N = k d^p, finite forces at work.
//
//   dv = A dtau + a dt,   A in [lo, hi], lo > 0,   d' = -v,   N = k d^p, p >= 1,   dtau = N dt,   v(0) = v0 < 0
//
// A is anything of that range, such as Wnn + Wtn f' with |f'| <= m: lo = Wnn - m |Wtn|, hi = Wnn + m |Wtn|. a is the
// finite forces' normal acceleration, g >= |a|. Unloading from the largest indentation D: N(d) = k e^p with the depth
// e = (d - (1 - eta^2) D)/eta^2. With P(d) = k d^(p+1)/(p+1), the work of first loading:
//
//   a depth    D >= D*, P(D*) = v0^2/(3 hi), if 6 g D* hi <= lo v0^2.  Else v0^2/2 = integral of (A N + a) over d
//              <= hi P(D) + g D < v0^2/3 + g D* <= v0^2/2.
//   loading    v^2/2 = integral of (A N + a) from d to D >= lo (P(D) - P(d)) - g (D - d). P is convex, so that
//              D - d <= (P(D) - P(d)) D/P(D); and g D/P(D) <= g D*/P(D*) <= lo/2. Hence v^2 >= lo (P(D) - P(d)).
//   unloading  likewise v^2/2 >= lo E - g s after the way s = eta^2 (D - e), E = eta^2 (P(D) - P(e)): v^2 >= lo E > 0.
//   time       integrals of dd/|v| and eta^2 de/v; with J = integral over [0, 1] of dz/sqrt(1 - z^(p+1)),
//              T <= (1 + eta) J sqrt((p + 1)/(k lo)) D*^((1 - p)/2)
//
// J is pi/2 for a linear spring, (2/5) B(2/5, 1/2) for that of Hertz. So v changes sign once. eta = 0 under finite
// forces is not bounded here: what is pressed down does not part. Nor are Hunt and Crossley's losses.

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

// T in s, enlarged by 2^-20 of itself; infinite where the conditions above fail.
double LongestContact(const NormalSpring& spring, const Indentation& of);

}  // namespace ricochet

#endif  // RICOCHET_CORE_PLAN_CONTACT_TIME_H_
