// Kane and Levinson's law: Coulomb's law between the whole impulse and the slip after the impact.
//
// T. R. Kane and D. A. Levinson, Dynamics: Theory and Applications, McGraw-Hill (1985), on collisions; with one
// coefficient mu where they allow a static and a kinetic one. v1 = -e v0, and either
//
//   stick   u1 = 0,  |f| <= mu tau1            or
//   slip    u1 != 0, f = -mu sgn(u1) tau1
//
// What the slip did on the way is not looked at, so that the law can create energy: Kane's paradox, a double pendulum
// that rebounds with several times the energy it had.
//
// How many solutions. With G and T of the sticking impulse (-G, T)/det W (G = u0 wnn + c wtn, T = c wtt + u0 wtn,
// c = -(1 + e) v0), stick needs |G| <= mu T; slip towards s = +-1 needs s G > mu T and D = wnn - s mu wtn > 0. Let
// det W > 0. From wtn G - wnn T = -c det W < 0:
//   - D <= 0 has s wtn mu >= wnn, whence s G > mu T would give wtn G > wnn T for T >= 0: a contradiction, so that the
//     slip which the cone asks for always has D > 0;
//   - T < 0 gives s G > mu T for s = sgn(G), and for the other s only if mu |T| > |G| > (wnn/|wtn|) |T|: then D < 0.
// Exactly one solution therefore, for any positive definite W. At rank one G = -e v0 wtn, u1 = G/wnn for any impulse:
//   - e > 0, wtn != 0: slip towards sgn(wtn) if mu |wtn| < wnn; else no solution, since friction locks the contact but
//     v1 = -e v0 asks for a rebound;
//   - e = 0 or wtn = 0: u1 = 0 whatever the impulse. wtn = 0: f = 0 is given. Else every impulse of the cone that ends
//     the approach will do; those at its sides are given, one if friction of the other side would lock the contact.
//     Velocities and energy are the same.

#ifndef RICOCHET_CORE_MODELS_LAWS_KANE_LEVINSON_H_
#define RICOCHET_CORE_MODELS_LAWS_KANE_LEVINSON_H_

#include "core/models/laws/impact_law.h"

namespace ricochet::laws {

// e >= 0. All solutions: stick first, then slip towards +t, then towards -t. Units, degenerate inputs and accuracy:
// core/models/laws/impact_law.h.
ImpactLawResult SolveKaneLevinson(const PlanarImpactInput& input, double e);

}  // namespace ricochet::laws

#endif  // RICOCHET_CORE_MODELS_LAWS_KANE_LEVINSON_H_
