// Sizes: for each effect, the most that leaving it out of an impact changes.
//
// A size bounds the change of any contact velocity after the impact and of any impulse times its mobility (Wnn tau,
// Wtt f; in space (W11 + W22) |f|), over V = max(|u0|, |v0|). Counting impulses keeps a law that fixes v1 by itself
// (Newton's) from hiding what friction does. Effects are left out one after another, so that sizes add up:
//
//   finite forces, finite duration, tangential compliance, static friction, slip that turns and stops, friction
//
// each from the impact that the ones before have left. All rest on core/plan/perturbed_path.h: A is the impact without
// the effect, B the one with it, scaled by |v0| and Wnn as there: w = |Wtn|/Wnn, W = Wtt/Wnn, s = sgn u0, and s w short
// for s Wtn/Wnn. c = m w, where m is the largest |f'|: mu, or |Wtn|/Wtt where the contact may stick (it does only if
// that is <= mu_s). c >= 1 is possible self-locking: v' may vanish, no bound is known, all sizes but 0 are infinite.
//
//   friction       A without friction, v' = 1. B: |f'| <= m, v' in [1 - c, 1 + c]. That is so for any law of friction,
//                  for a compliant contact too (|F| <= mu N). Nor can friction do more than hold: it only takes from
//                  u^2/2 W + (what a tangential spring stores), to which w adds at most w |u|/W, so that
//                  |u_B| <= |u0| + w tau and |f_B| = |u_B - u0 - wtn tau|/W <= 2 (|u0| + w tau)/W. A rigid contact whose slip
//                  stops at tau_s to stick: |f_B| <= mu tau_s + (w/W)(tau - tau_s)+, v' = 1 - s mu w, then 1 - w^2/W.
//                  The smallest bound counts.
//   pendulum       exactly, with x = mu |b|/a, r = (1 - x)/(1 + x), in units of a |w-|:
//                  |d v1| = eta (1 - sqrt r), Poisson 2 k x/(1 + x), Newton 0; |d u1| = |b|/a |d v1|;
//                  Wnn tau1 = (1 + kappa)/(1 + x) in place of 1 + c; Wtt f1 = (|b|/a) x (1 - kappa)/(1 + x).
//   slip that      A slides on: straight, v' = 1 - s mu w, s u' = s w - mu W. B is the same up to tau_s = |u0|/(mu W - s w);
//   stops          then it sticks, f' off by mu - s w/W and v' = 1 - w^2/W, or reverses, f' off by 2 mu and
//                  v' = 1 - mu w. Size 0 if A's s u is above its rounding up to A's end: then B never stops either.
//   static         comes in only if slip rests (as above) and mu W < w <= mu_s W, decided exactly. A reverses, B sticks:
//   friction       f' off by w/W - mu from tau_s on. Or both against slip that goes on, if that sum is smaller.
//   tangential     A rigid. B: particle with speed S = s u + mu ratio^2 kn v as it slides, kn = 1 in compression and
//   compliance     1/eta^2 after. If S > 0 at the start, s u0 > mu ratio^2 |v0|, and s u > 0 up to A's end, then
//                  S > 0 throughout, it being linear in tau in compression and >= s u after: both slide,
//                  the impulses are the same, size 0. Else the smallest of
//                  1. twice friction's bound: both lie within that of the frictionless impact;
//                  2. |f_B - f_A| = |u_B - u_A|/W <= 2 (|u0| + w tau)/W, as for friction;
//                  3. twice (f' off by 2 mu from tau_p on), against slip that goes on: until tau_p, when S as above or
//                     s u first vanishes, both slide;
//                  4. where w > mu W, sgn wtn u grows by at least a = w - mu W: A slides that way once it has
//                     stopped. S = u sgn wtn + mu ratio^2 v is above a (tau - t0) from t0 = (mu ratio^2 - u0 sgn wtn)/a
//                     on. In a stick the gap between mu N and the force shrinks at the rate S in time, from at most
//                     2 mu N ratio^2/k, N^2/2k <= tau being the work so far: closed, for B to slide that way for good, when
//                     a (tau - t0)^2/2 >= 4 mu ratio^2 tau. If that is still in compression, |f_B - f_A| <= 2 mu tau.
//                  So no inequality tells how a stick ends once slip may stop; only that it does little.
//   finite         Without finite forces time is no part of the equations in tau, and any spring that gives back eta^2
//   duration       of its work ends where eta does: size 0. Hunt and Crossley's damping is the restitution itself:
//                  infinite.
//   finite forces  T bounds the duration (core/plan/contact_time.h, with |f'| <= mu_s). Coulomb's law with mu_s = mu is
//                  monotone: d(u_B - u_A) = Wtt (f_B' - f_A') dtau + a_t dt with (u_B - u_A)(f_B' - f_A') <= 0, so that
//                  |u_B - u_A| <= |a_t| T, |f_B - f_A| <= 2 |a_t| T/Wtt, |v_B - v_A| <= |a_n| T + |Wtn| of that. If s u
//                  stays above |a_t| T (and S above |a_t| T + mu ratio^2 |a_n| T) by the end of A and a quarter more,
//                  both slide on, for any mu_s and ratio, and f is the same. Else, with mu_s > mu or
//                  compliance, no bound is known. Left out together with friction: A frictionless, |f_B'| <= mu_s.
//   higher order   of a pendulum in x: what core/models/pendulum/first_order.h states, rounding included.
//
// In space (w = |wtn|/Wnn, W the trace of Wtt over Wnn, e0 = u0/|u0|, s = |u|):
//
//   friction       as above, m = max(mu, |Wtt^-1 wtn| where that is <= mu_s).
//   slip that      A slides on along e0. phi' = g(phi) per dxi = dtau/s, and g and h change by at most
//   turns          l = mu (lambda_max - lambda_min) + |wtn| per radian. Suppose |phi - phi0| <= D. Then v' is within mu w D
//                  of A's, which bounds tau1 <= T; s >= s0 + (h(phi0) - l D) tau, which at T has to be > 0; xi is at most
//                  X = (1/s0 + 1/s(T)) T/2, the integrand being convex; and |phi - phi0| <= |g(phi0)| (e^(l X) - 1)/l
//                  <= |g(phi0)| X/(1 - l X/2) = D'. If D' < D, phi cannot be the first to reach D: D' is proved, with
//                  s > 0. f' is off by at most mu D'. Size 0 where Wtt is a multiple of 1 and wtn = 0.
//   that stops     size 0 where the above proves s > 0; where slip cannot turn, as in a plane; else infinite.
//   static         as in a plane, with q = |Wtt^-1 wtn| in place of w/W, from tau = s0/(mu lambda_max + |wtn|) on:
//   friction       f' off by mu + q.
//
// Rounding is covered as core/plan/perturbed_path.h says; a 0 is exact.

#ifndef RICOCHET_CORE_PLAN_SIZES_H_
#define RICOCHET_CORE_PLAN_SIZES_H_

#include <array>
#include <cstddef>

#include "core/models/pendulum/pendulum.h"
#include "core/models/planar/planar.h"
#include "core/models/spatial/spatial.h"
#include "ricochet/plan.h"
#include "ricochet/scene.h"

namespace ricochet {

// What a planar contact has beyond the rigid impact. The coefficient of restitution is then the energetic one.
struct ContactPhysics {
  double ratio_squared = 0.0;            // Tangential over normal compliance; 0 is rigid along t.
  NormalSpring spring;                   // std::monostate: the impact takes no time.
  double tangential_acceleration = 0.0;  // a_t of core/models/finite_duration/finite_duration.h, m/s^2
  double normal_acceleration = 0.0;      // a_n
};

// Where a size comes from.
enum class Ground {
  kNotInScene,        // 0: the scene has it not.
  kNotOfSystem,       // 0: such a system cannot have it.
  kImmobile,          // 0: Wtt = 0.
  kSlidesThroughout,  // 0: slip never stops. number: |u| at the end, m/s; in space no more than it is
  kStraight,          // 0: slip keeps its direction.
  kDecidesNothing,    // 0: the contact sticks, or slides, by either coefficient of friction.
  kNoSpring,          // 0: forces have no time to act in.
  kSameImpulses,      // 0: a spring in time, with the rigid impact's impulses.
  kInequality,        // number: what it is in, see below
  kSelfLocking,       // Infinite: c >= 1. number: c
  kStaysAtRest,       // Infinite: the contact sticks from the start.
  kStopsAtRest,       // Infinite: a pendulum's slip stops where compression ends.
  kNoInequality,      // Infinite: none is known.
  kDamped,            // Infinite: the damping is the restitution.
};

// The numbers of kInequality: friction c (a pendulum's x); slip that stops and static friction the share of the normal
// impulse that has passed by then, at least; slip that turns the angle, rad; finite forces T, s; higher order x.
struct Size {
  double value = 0.0;
  Ground ground = Ground::kNotInScene;
  double number = 0.0;

  // Nothing is lost, or even to be mentioned, by leaving it out.
  bool IsAbsent() const { return value == 0.0 && ground != Ground::kSameImpulses; }
};

struct Sizes {
  std::array<Size, kEffectCount> of = {};
  double forces_beyond_friction = 0.0;  // Of finite forces where friction is left out too.

  Size& operator[](Effect effect) { return of[static_cast<size_t>(effect)]; }
  const Size& operator[](Effect effect) const { return of[static_cast<size_t>(effect)]; }
};

// v0 < 0. `slips_on`: slip is taken not to stop, because the caller excludes that.
Sizes PlanarSizes(const planar::Problem& problem, const ContactPhysics& physics, bool slips_on = false);
Sizes SpatialSizes(const spatial::Problem& problem);
Sizes PendulumSizes(const pendulum::Problem& problem, const ContactPhysics& physics);

// Two of a rigid pendulum's, for whoever needs no others.
Size PendulumFrictionSize(const pendulum::Problem& problem);
Size PendulumHigherOrderSize(const pendulum::Problem& problem);

// The contact of a pendulum.
planar::Problem PlanarOf(const pendulum::Problem& problem);

}  // namespace ricochet

#endif  // RICOCHET_CORE_PLAN_SIZES_H_
