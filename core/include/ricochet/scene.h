// Scene: what is asked. A system that strikes a surface, friction between the two, and one coefficient of restitution.
//
// A Scene is plain data, exactly what ricochet.v1.Scene carries; nothing in it has been checked. Validate
// (core/scene/validate.h) is the door: below it, code takes every rule stated here for granted.
// SI units and radians.

#ifndef RICOCHET_SCENE_H_
#define RICOCHET_SCENE_H_

#include <optional>
#include <variant>
#include <vector>

#include "ricochet/system.h"

namespace ricochet {

// What a coefficient is multiplied by, as a function of the approach speed |v0|: of the contact, along n, relative to
// the surface; 0 where the contact separates. A product that the coefficient may not be is refused.
struct PowerLaw {
  double alpha = 0.0;     // factor = 1 - alpha |v0|^exponent
  double exponent = 0.0;  // >= 0
  friend bool operator==(const PowerLaw&, const PowerLaw&) = default;
};
struct SpeedTable {
  std::vector<double> speed_m_s;  // >= 0, strictly rising, at least one.
  std::vector<double> factor;     // One a speed; linear in between, constant outside.
  friend bool operator==(const SpeedTable&, const SpeedTable&) = default;
};
// std::monostate: the request left the choice open, which Validate reports.
using SpeedDependence = std::variant<std::monostate, PowerLaw, SpeedTable>;

// Dry (Amontons-Coulomb) friction, |F| <= mu N.
struct Friction {
  double kinetic_coefficient = 0.0;          // mu of sliding, >= 0. 0 is a smooth surface.
  std::optional<double> static_coefficient;  // mu_s of sticking, >= mu; absent means mu.
  std::optional<SpeedDependence> by_speed;   // Of both; absent means constant.

  friend bool operator==(const Friction&, const Friction&) = default;
};

// The three definitions of the coefficient of restitution. They differ under friction; a scene states exactly one.
struct NewtonCoefficient {
  double value = 0.0;  // -v+/v-, >= 0. Lubarda Eq. (14).
  friend bool operator==(const NewtonCoefficient&, const NewtonCoefficient&) = default;
};
struct PoissonCoefficient {
  double value = 0.0;  // Restitution's normal impulse / compression's, >= 0. Lubarda Eq. (10).
  friend bool operator==(const PoissonCoefficient&, const PoissonCoefficient&) = default;
};
struct EnergeticCoefficient {
  double value = 0.0;  // sqrt(-Wr/Wc) of the normal works, in [0, 1]. Stronge; Lubarda Eq. (19).
  friend bool operator==(const EnergeticCoefficient&, const EnergeticCoefficient&) = default;
};

// A moving surface; contact velocities are those relative to it. Not for a body pair.
struct SurfaceVelocity {
  std::vector<double> tangential_m_s;  // One entry in a plane, two in space.
  double normal_m_s = 0.0;

  friend bool operator==(const SurfaceVelocity&, const SurfaceVelocity&) = default;
};

// How the contact gives way. Planar systems with the energetic coefficient, or with Hunt and Crossley's damping.
struct LinearSpring {
  double stiffness_n_m = 0.0;  // k of N = k d, > 0
  friend bool operator==(const LinearSpring&, const LinearSpring&) = default;
};
struct HertzSpring {
  double stiffness_n_m1_5 = 0.0;  // k of N = k d^(3/2), > 0
  friend bool operator==(const HertzSpring&, const HertzSpring&) = default;
};
// Hunt and Crossley (1975). The damping stands for the coefficient of restitution, which must then be unset.
struct HuntCrossleySpring {
  double stiffness_n_m_p = 0.0;  // k of N = k d^p (1 + c d'), N/m^p, > 0
  double exponent = 0.0;         // p, in [1, 4]
  double damping_s_m = 0.0;      // c, >= 0
  friend bool operator==(const HuntCrossleySpring&, const HuntCrossleySpring&) = default;
};
// std::monostate: of a stiffness that is not stated. The impact takes no time.
using NormalSpring = std::variant<std::monostate, LinearSpring, HertzSpring, HuntCrossleySpring>;

struct Compliance {
  // Tangential over normal compliance, in [1e-9, 1e9]; (2 - nu)/(2 (1 - nu)) for spheres of Poisson's ratio nu. Absent
  // means rigid along the surface. Not with HertzSpring or HuntCrossleySpring, nor with static above kinetic friction.
  std::optional<double> tangential_ratio_squared;
  NormalSpring normal;
  friend bool operator==(const Compliance&, const Compliance&) = default;
};

// Forces that act all the while, an impact or not. They count for as long as the contact lasts, so that a scene without
// a normal spring knows no effect of theirs. What depends on velocities squared is left out: W is held constant too.
struct Gravity {  // On planar bodies, pairs and linkages.
  double tangential_m_s2 = 0.0;
  double normal_m_s2 = 0.0;
  friend bool operator==(const Gravity&, const Gravity&) = default;
};
struct PinMoment {  // On a pendulum, counter-clockwise about the pin.
  double moment_n_m = 0.0;
  friend bool operator==(const PinMoment&, const PinMoment&) = default;
};
struct ContactAcceleration {  // On a planar contact: what the finite forces alone would give it.
  double tangential_m_s2 = 0.0;
  double normal_m_s2 = 0.0;
  friend bool operator==(const ContactAcceleration&, const ContactAcceleration&) = default;
};
// std::monostate: none.
using FiniteForces = std::variant<std::monostate, Gravity, PinMoment, ContactAcceleration>;

// Laws to compare with, in place of Coulomb friction at every instant and restitution. Planar systems only.
struct WhittakerLaw {
  double e = 0.0;  // >= 0
  friend bool operator==(const WhittakerLaw&, const WhittakerLaw&) = default;
};
struct KaneLevinsonLaw {
  double e = 0.0;  // >= 0
  friend bool operator==(const KaneLevinsonLaw&, const KaneLevinsonLaw&) = default;
};
struct BrachLaw {
  double e = 0.0;       // >= 0
  double mu_hat = 0.0;  // Tangential / normal impulse, signed.
  friend bool operator==(const BrachLaw&, const BrachLaw&) = default;
};
struct ChatterjeeRuinaLaw {
  double e = 0.0;    // >= 0
  double e_t = 0.0;  // In [-1, 1].
  friend bool operator==(const ChatterjeeRuinaLaw&, const ChatterjeeRuinaLaw&) = default;
};

// std::monostate: the request left the choice open, which Validate reports.
using Restitution = std::variant<std::monostate, NewtonCoefficient, PoissonCoefficient, EnergeticCoefficient>;
// std::monostate: Coulomb friction and the scene's restitution.
using ImpactLaw = std::variant<std::monostate, WhittakerLaw, KaneLevinsonLaw, BrachLaw, ChatterjeeRuinaLaw>;

struct Scene {
  System system;
  Friction friction;
  Restitution restitution;                              // Unset exactly if impact_law is set; bounds need neither.
  std::optional<SpeedDependence> restitution_by_speed;  // Absent means constant.
  std::optional<SurfaceVelocity> surface_velocity;      // Absent means at rest.
  ImpactLaw impact_law;
  std::optional<Compliance> compliance;  // Absent means rigid. Not with an impact law.
  FiniteForces finite_forces;            // Not with an impact law.

  friend bool operator==(const Scene&, const Scene&) = default;
};

}  // namespace ricochet

#endif  // RICOCHET_SCENE_H_
