// ScaledContact: a contact of finite duration in natural units, with its spring, its inertia and the finite forces.
//
// The unit of velocity is |v0|, that of mass 1/Wnn. The unit of time T is that in which they make the spring's own
// force, k Wnn |v0|^(p-1) T^(p+1) = 1 for N = k d^p; or |v0|/a_n, in which a_n > 0 alone would reverse v, if that is
// less. Then v0 = -1, Wnn = 1, a_n <= 1 and the spring's stiffness is K <= 1 (docs/theory/finite_duration.md, "Units").

#ifndef RICOCHET_CORE_MODELS_FINITE_DURATION_SCALED_CONTACT_H_
#define RICOCHET_CORE_MODELS_FINITE_DURATION_SCALED_CONTACT_H_

#include "core/models/finite_duration/finite_duration.h"

namespace ricochet::finite_duration {

inline double Square(double x) { return x * x; }

struct Acceleration {
  double u = 0.0, v = 0.0;
};

struct ScaledContact {
  int rank = 2;  // Rank of W.
  double wtt = 0.0, wtn = 0.0;
  // d(u, v)/dtau of slip towards +t and -t: differences that may cancel, each rounded once.
  Acceleration forward_slope, backward_slope;
  double stick_slope = 0.0;  // det W/Wtt, the v' of a contact that sticks over N.
  double u0 = 0.0;
  double at = 0.0, an = 0.0;
  double mu = 0.0, mu_static = 0.0;
  double stiffness = 1.0;  // K
  double exponent = 1.0;   // p
  bool rooted = false;     // p != 1: the place that is integrated is q with x = q^2.
  bool damped = false;     // The law is that of Hunt and Crossley.
  double damping = 0.0;    // c
  bool pulled = false;     // It is damped, and finite forces may pull it apart.
  double eta = 1.0;        // 1 for Hunt and Crossley, whose loading and unloading are one curve.
  bool compliant = false;
  double ratio_squared = 0.0;
  bool smooth = false;        // There is no friction force: mu_s = 0, or Wtt = 0 without slip.
  bool coupled = false;       // W has rank one with the velocity and the forces in its range: u = wtn v throughout.
  bool holds_freely = false;  // mu_s Wtt >= |Wtn|: it sticks where no finite force pulls.
  double speed = 0.0, time = 0.0, mass = 0.0;  // The units.

  // Without forces, damping and a spring along t, u and v are linear in tau while a mode lasts.
  bool IsStraight() const { return at == 0.0 && an == 0.0 && !damped && !compliant; }
  const Acceleration& SlipSlope(double direction) const { return direction < 0.0 ? backward_slope : forward_slope; }

  double Length() const { return speed * time; }
  double Force() const { return mass * speed / time; }
  double Impulse() const { return mass * speed; }
  double Energy() const { return mass * speed * speed; }
};

// The contact approaches: v0 < 0.
ScaledContact MakeScaledContact(const Problem& problem);

}  // namespace ricochet::finite_duration

#endif  // RICOCHET_CORE_MODELS_FINITE_DURATION_SCALED_CONTACT_H_
