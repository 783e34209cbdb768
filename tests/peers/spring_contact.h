// SpringContact: the spring and the damper that stand for a coefficient of restitution in engines with soft contacts.
//
// A frictionless contact of the pendulum is a mass m = J0/a^2 on a linear spring and damper, m x'' + d x' + k x = 0,
// and it ends when the force has fallen to zero. Its restitution then depends on the damping ratio zeta alone:
//
//   e = exp(-zeta/s (pi - atan2(2 zeta s, s^2 - zeta^2))),   s = sqrt(1 - zeta^2)
//
// (Schwager and Poeschel 2007, doi:10.1007/s10035-007-0065-z.) Friction changes the mass that the damper sees, so that
// under friction an engine with these numbers has no exact coefficient; for e = 1 there is no damper and the question
// does not arise.

#ifndef RICOCHET_TESTS_PEERS_SPRING_CONTACT_H_
#define RICOCHET_TESTS_PEERS_SPRING_CONTACT_H_

#include "tests/peers/peer.h"

namespace ricochet::peers {

// Soft contacts last this long, in s. The pendulum turns by about 3e-6 rad meanwhile, so that its geometry stays.
inline constexpr double kContactTime = 1e-5;

struct SpringContact {
  double stiffness = 0.0;  // N/m
  double damping = 0.0;    // N s/m
  double mass = 0.0;       // kg, J0/a^2
};

// Returns zeta in [0, 1) with which a frictionless contact rebounds with the coefficient `restitution` in (0, 1].
double DampingRatio(double restitution);

// Returns the spring and damper with which a contact without damping would last `contact_time` seconds.
SpringContact SpringFor(const PendulumCase& c, double contact_time);

}  // namespace ricochet::peers

#endif  // RICOCHET_TESTS_PEERS_SPRING_CONTACT_H_
