// Sizes: for each effect, a bound on the change that leaving it out of an impact makes.
//
// The size bounds the change of any contact velocity after the impact and of any impulse times its mobility (Wnn tau,
// Wtt f; in space (W11 + W22) |f|), divided by the approach speed |v0|. Effects are left out one after another,
//
//   finite forces, finite duration, tangential compliance, static friction, slip that turns, slip that stops, friction
//
// each from the impact that the ones before have left, so that sizes add up. A size is infinite if no bound is known,
// and 0 only if the effect changes nothing at all. Rounding is covered as core/plan/perturbed_path.h says.
// The problem must be valid. docs/theory/plan.md, sections 1, 3 and 4, derives every size; its symbols are used here
// and in sizes.cc: w = |Wtn|/Wnn, W = Wtt/Wnn, s = sgn u0, m the largest |f'| and c = m w. A is the impact without an
// effect, B the one with it.

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

// The parts of a planar contact beyond the rigid impact. If there are any, the coefficient of restitution is the
// energetic one.
struct ContactPhysics {
  double ratio_squared = 0.0;            // Tangential over normal compliance; 0 is rigid along t.
  NormalSpring spring;                   // std::monostate: the impact takes no time.
  double tangential_acceleration = 0.0;  // a_t of core/models/finite_duration/finite_duration.h, m/s^2
  double normal_acceleration = 0.0;      // a_n
};

// The reason for a size. Sizes are 0 up to kSameImpulses, and infinite from kSelfLocking on.
enum class Basis {
  kNotInScene,             // The scene does not have the effect.
  kNotOfSystem,            // Such a system cannot have the effect.
  kImmobile,               // Wtt = 0: impulses along t move nothing.
  kSlidesThroughout,       // Slip never stops. number: |u| at the end, m/s; in space a lower bound on it.
  kStraight,               // Slip keeps its direction.
  kDecidesNothing,         // The contact sticks by both coefficients of friction, or slides by both.
  kNoSpring,               // The impact takes no time, so that finite forces do not act.
  kSameImpulses,           // The impact takes time, but its impulses are those of the rigid impact.
  kInequality,             // An inequality bounds the size. number: see Size.
  kSelfLocking,            // Self-locking is possible. number: c >= 1
  kStaysAtRest,            // The contact sticks from the start.
  kStopsAtCompressionEnd,  // The slip of a pendulum stops where compression ends.
  kNoInequality,           // No bound is known.
  kDamped,                 // The damping of the spring is the restitution.
};

// For kInequality, `number` is c for friction (x for a pendulum), the least share of the normal impulse before slip
// stops for slip that stops and static friction, the angle in rad for slip that turns, T in s for finite forces, and x
// for higher order.
struct Size {
  double value = 0.0;
  Basis basis = Basis::kNotInScene;
  double number = 0.0;

  // True if the scene's answer and its duration are the same without the effect.
  bool IsAbsent() const { return value == 0.0 && basis != Basis::kSameImpulses; }
};

struct Sizes {
  std::array<Size, kEffectCount> of = {};
  double forces_beyond_friction = 0.0;  // Size of finite forces beyond that of friction, if both are left out.

  Size& operator[](Effect effect) { return of[static_cast<size_t>(effect)]; }
  const Size& operator[](Effect effect) const { return of[static_cast<size_t>(effect)]; }
};

// These require v0 < 0. If `slips_on`, slip does not stop, because the caller excludes that.
Sizes PlanarSizes(const planar::Problem& problem, const ContactPhysics& physics, bool slips_on = false);
Sizes SpatialSizes(const spatial::Problem& problem);
Sizes PendulumSizes(const pendulum::Problem& problem, const ContactPhysics& physics);

// Two of the sizes of a rigid pendulum, for callers that need no others.
Size PendulumFrictionSize(const pendulum::Problem& problem);
Size PendulumHigherOrderSize(const pendulum::Problem& problem);

// The pendulum's impact as that of a planar contact; its numbers are rounded products of the pendulum's.
planar::Problem PlanarOf(const pendulum::Problem& problem);

}  // namespace ricochet

#endif  // RICOCHET_CORE_PLAN_SIZES_H_
