// Scene: what is asked. A system that strikes a surface, friction between the two, and one coefficient of restitution.
//
// A Scene is plain data, exactly what ricochet.v1.Scene carries; nothing in it has been checked. Validate
// (core/scene/validate.h) is the door: below it, code takes every rule stated here for granted.
// SI units and radians.

#ifndef RICOCHET_CORE_SCENE_SCENE_H_
#define RICOCHET_CORE_SCENE_SCENE_H_

#include <optional>
#include <variant>

namespace ricochet {

// A rigid body that turns about a fixed frictionless pin O and strikes a fixed horizontal surface at the point
// (a, -b) seen from O. t points to the right, n up; counter-clockwise turns are positive. Contact velocity: u = b w
// along t, v = a w along n. Lubarda (2009), Fig. 1 and Eq. (1).
struct Pendulum {
  double inertia_kg_m2 = 0.0;      // J0 about the pin, > 0.
  double a_m = 0.0;                // Horizontal distance pin to contact, > 0.
  double b_m = 0.0;                // Depth of the contact below the pin, of either sign.
  double omega_minus_rad_s = 0.0;  // w-, the angular velocity of incidence; >= 0 means separating: nothing happens.

  friend bool operator==(const Pendulum&, const Pendulum&) = default;
};

// Dry (Amontons-Coulomb) friction, |F| <= mu N.
struct Friction {
  double kinetic_coefficient = 0.0;          // mu of sliding, >= 0. 0 is a smooth surface.
  std::optional<double> static_coefficient;  // mu_s of sticking, >= mu; absent means mu.

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

// std::monostate: the request left the choice open, which Validate reports.
using System = std::variant<std::monostate, Pendulum>;
using Restitution = std::variant<std::monostate, NewtonCoefficient, PoissonCoefficient, EnergeticCoefficient>;

struct Scene {
  System system;
  Friction friction;
  Restitution restitution;

  friend bool operator==(const Scene&, const Scene&) = default;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_SCENE_SCENE_H_
