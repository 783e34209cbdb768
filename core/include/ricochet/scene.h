// Scene: the question. A system strikes a surface, with friction between the two and one coefficient of restitution.
//
// A Scene is plain data that mirrors ricochet.v1.Scene; nothing in it has been checked. Every
// call of a Solver checks every rule stated here first, and all other code relies on them. Units are SI units and
// radians.

#ifndef RICOCHET_SCENE_H_
#define RICOCHET_SCENE_H_

#include <optional>
#include <variant>
#include <vector>

#include "ricochet/system.h"

namespace ricochet {

// A SpeedDependence is a factor by which a coefficient is multiplied, as a function of the approach speed |v0|. This is
// the speed of the contact along n relative to the surface, or 0 if the contact separates. Validate refuses a scene
// whose product is not a value that the coefficient may have.
struct PowerLaw {
  double alpha = 0.0;     // factor = 1 - alpha |v0|^exponent
  double exponent = 0.0;  // >= 0
  friend bool operator==(const PowerLaw&, const PowerLaw&) = default;
};
struct SpeedTable {
  std::vector<double> speed_m_s = {};  // >= 0, strictly rising, at least one.
  std::vector<double> factor = {};     // One for each speed; linear between two speeds, constant outside.
  friend bool operator==(const SpeedTable&, const SpeedTable&) = default;
};
// std::monostate means that the request stated none, which Validate reports.
using SpeedDependence = std::variant<std::monostate, PowerLaw, SpeedTable>;

// Dry (Amontons-Coulomb) friction, |F| <= mu N. In space mu is at most 2^460.
struct Friction {
  double kinetic_coefficient = 0.0;               // mu while the contact slides, >= 0; 0 is a smooth surface.
  std::optional<double> static_coefficient = {};  // mu_s while it sticks, >= mu; absent means mu.
  std::optional<SpeedDependence> by_speed = {};   // Factor of both coefficients; absent means 1.

  friend bool operator==(const Friction&, const Friction&) = default;
};

// The coefficient of restitution has three definitions, which differ under friction. A scene states exactly one.
struct NewtonCoefficient {
  double value = 0.0;  // -v+/v-, >= 0. Lubarda Eq. (14).
  friend bool operator==(const NewtonCoefficient&, const NewtonCoefficient&) = default;
};
struct PoissonCoefficient {
  double value = 0.0;  // Normal impulse of restitution / that of compression, >= 0. Lubarda Eq. (10).
  friend bool operator==(const PoissonCoefficient&, const PoissonCoefficient&) = default;
};
struct EnergeticCoefficient {
  double value = 0.0;  // sqrt(-Wr/Wc) with the normal works of both phases, in [0, 1]. Stronge; Lubarda Eq. (19).
  friend bool operator==(const EnergeticCoefficient&, const EnergeticCoefficient&) = default;
};

// The velocity of a moving surface; contact velocities are relative to it. A body pair has no surface.
struct SurfaceVelocity {
  std::vector<double> tangential_m_s = {};  // One entry in a plane, two in space; empty: 0 each.
  double normal_m_s = 0.0;

  friend bool operator==(const SurfaceVelocity&, const SurfaceVelocity&) = default;
};

// A compliant contact deforms along n, along t or both. Only planar systems with the energetic coefficient, or with
// Hunt and Crossley's damping, may state one. N is the normal force, d the indentation and d' its rate.
struct LinearSpring {
  double stiffness_n_m = 0.0;  // k of N = k d, > 0
  friend bool operator==(const LinearSpring&, const LinearSpring&) = default;
};
struct HertzSpring {
  double stiffness_n_m1_5 = 0.0;  // k of N = k d^(3/2), > 0
  friend bool operator==(const HertzSpring&, const HertzSpring&) = default;
};
// The spring of Hunt and Crossley (1975). Its damping takes the place of the coefficient of restitution, which must
// then be unset.
struct HuntCrossleySpring {
  double stiffness_n_m_p = 0.0;  // k of N = k d^p (1 + c d'), N/m^p, > 0
  double exponent = 0.0;         // p, in [1, 4]
  double damping_s_m = 0.0;      // c, >= 0
  friend bool operator==(const HuntCrossleySpring&, const HuntCrossleySpring&) = default;
};
// std::monostate means that no stiffness is stated: the impact takes no time.
using NormalSpring = std::variant<std::monostate, LinearSpring, HertzSpring, HuntCrossleySpring>;

struct Compliance {
  // Tangential over normal compliance, in [1e-9, 1e9]; (2 - nu)/(2 (1 - nu)) for spheres of Poisson's ratio nu. Absent
  // means rigid along the surface. It must be absent with a HertzSpring or HuntCrossleySpring, and if static friction
  // is above kinetic friction.
  std::optional<double> tangential_ratio_squared = {};
  NormalSpring normal = {};
  friend bool operator==(const Compliance&, const Compliance&) = default;
};

// Finite forces act before, during and after the impact. They change it only as long as the contact lasts, so that they
// have no effect in a scene without a normal spring. Terms in the squares of velocities are left out, and W is
// constant.

// Gravity acts on planar bodies, pairs and linkages.
struct Gravity {
  double tangential_m_s2 = 0.0;
  double normal_m_s2 = 0.0;
  friend bool operator==(const Gravity&, const Gravity&) = default;
};
// A moment about the pin of a pendulum, counter-clockwise.
struct PinMoment {
  double moment_n_m = 0.0;
  friend bool operator==(const PinMoment&, const PinMoment&) = default;
};
// The acceleration that the finite forces alone would give a planar contact.
struct ContactAcceleration {
  double tangential_m_s2 = 0.0;
  double normal_m_s2 = 0.0;
  friend bool operator==(const ContactAcceleration&, const ContactAcceleration&) = default;
};
// std::monostate means that no finite forces act.
using FiniteForces = std::variant<std::monostate, Gravity, PinMoment, ContactAcceleration>;

// An impact law maps the contact velocity before the impact to that after it. It takes the place of restitution and of
// Coulomb friction at every instant, and serves for comparison. Only planar systems may state one.
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
  double mu_hat = 0.0;  // Tangential over normal impulse, signed.
  friend bool operator==(const BrachLaw&, const BrachLaw&) = default;
};
struct ChatterjeeRuinaLaw {
  double e = 0.0;    // >= 0
  double e_t = 0.0;  // In [-1, 1].
  friend bool operator==(const ChatterjeeRuinaLaw&, const ChatterjeeRuinaLaw&) = default;
};

// std::monostate means that the request stated none, which Validate reports.
using Restitution = std::variant<std::monostate, NewtonCoefficient, PoissonCoefficient, EnergeticCoefficient>;
// std::monostate means that Coulomb friction and the scene's restitution hold.
using ImpactLaw = std::variant<std::monostate, WhittakerLaw, KaneLevinsonLaw, BrachLaw, ChatterjeeRuinaLaw>;

struct Scene {
  System system = {};
  Friction friction = Friction();                            // GCC 12 warns of uninitialised members after `= {}`.
  Restitution restitution = {};                              // Unset exactly if impact_law or a HuntCrossleySpring is.
  std::optional<SpeedDependence> restitution_by_speed = {};  // Absent means constant.
  std::optional<SurfaceVelocity> surface_velocity = {};      // Absent means at rest.
  ImpactLaw impact_law = {};
  std::optional<Compliance> compliance = {};  // Absent means rigid; must be absent with an impact law.
  FiniteForces finite_forces = {};            // Must be unset with an impact law.

  friend bool operator==(const Scene&, const Scene&) = default;
};

// True for a scene with a normal spring, whose impacts take time.
bool TakesTime(const Scene& scene);

}  // namespace ricochet

#endif  // RICOCHET_SCENE_H_
