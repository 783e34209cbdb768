// The bounds of the coefficients of a planar contact: what they come to when the energetic one runs from 0 to 1.
//
// The path of a planar impact (core/models/planar/planar.h) does not depend on the coefficient of restitution; that only says
// how far along it restitution goes. Restitution ends at tau1, between tau_c where it is 0 and tau_e where the
// energetic one is 1, and with tau1 grow
//   Newton's  v(tau1)/|v0|      since v' > 0 in restitution,
//   Poisson's tau1/tau_c - 1.
// Brach's mu_hat = f(tau1)/tau1 could turn at a breakpoint of f. It does not: f has at most one, tau_s where slip
// stops, f/tau is constant before tau_s (f = -mu s tau) and monotone after it (a constant plus one over tau), so its
// extremes are its values at tau_c and tau_e. Newton's and Poisson's bounds may exceed 1: such an impact is admissible.
//
// By energy alone: E' = f'u + v rises along the path (its slope is (f', 1) W (f', 1)^T > 0, and it is v where slip
// stops), so E comes back to E- at one tau after tau_e.
//
// Critical coefficients of friction, other things equal, with s = sgn(u0), p = |u0|, w = -v0, q = s Wtn:
//   stick               |Wtn|/Wtt                          contact that has stopped sticks from here on (static friction)
//   stop_compression    (Wnn p + w q)/(w Wtt + q p)        above: slip stops before compression ends
//   stop                (Wnn p + 2 w q)/(2 w Wtt + q p)    above: slip stops before an elastic impact ends
//   reversal            stop, if q < 0 and stop < stick    from here to `stick`, slip reverses in an elastic impact
//   jam                 Wnn/|Wtn|, if q > 0                above: sliding drives the contact in at first, v' < 0
// At rank one slip stops where compression ends, whatever the friction: there is no stop_compression. Where Wtt = 0
// friction moves nothing and none is critical.
// Wang and Mason (1992) draw these as lines of an impulse plane.
//
// Accuracy: `sharp` is that of planar::Solve, but that a bound which rounding would push past what Solve accepts as
// admissible is a few doubles lower. `energy_only` and the critical coefficients lose what their formulas cancel: some
// 8 ulp of the largest term. Bad input: none gets here (core/scene/validate.h).

#ifndef RICOCHET_CORE_BOUNDS_CONTACT_BOUNDS_H_
#define RICOCHET_CORE_BOUNDS_CONTACT_BOUNDS_H_

#include "core/models/planar/planar.h"
#include "ricochet/bounds.h"

namespace ricochet::planar {

struct ContactBounds {
  Regime regime = Regime::kUnspecified;  // Of the elastic impact, which goes through all that the others do.
  int w_rank = 0;
  CoefficientBounds sharp;        // Fed back to Solve, each end is admissible. All 0 where separating.
  CoefficientBounds energy_only;  // Weaker: what kinetic energy alone allows.
  CriticalFriction critical;
  friend bool operator==(const ContactBounds&, const ContactBounds&) = default;
};

// `problem.law` and `problem.coefficient` are not used.
ContactBounds SolveBounds(const Problem& problem);

}  // namespace ricochet::planar

#endif  // RICOCHET_CORE_BOUNDS_CONTACT_BOUNDS_H_
