// One valid system of each kind, approaching.

#ifndef RICOCHET_TESTS_SUPPORT_SCENES_SYSTEM_SCENES_H_
#define RICOCHET_TESTS_SUPPORT_SCENES_SYSTEM_SCENES_H_

#include <vector>

#include "ricochet/scene.h"

namespace ricochet {

inline PlanarBody Flat() { return {1.0, 0.1, 0.2, -0.3, 1.0, -2.0, 0.5}; }
inline SpatialBody Body() { return {1.0, {0.3, 0.1, 0.0, 0.2, 0.0, 0.4}, {0.1, 0.2, -0.3}, {1, 2, -3}, {0, 0, 1}}; }
// Links of the same kind that hang at different angles.
inline Linkage Chain(size_t links = 2) {
  Linkage chain;
  for (size_t i = 0; i < links; ++i) {
    chain.links.push_back({.length_m = 1.0,
                           .mass_kg = 1.0,
                           .com_m = 0.5,
                           .inertia_com_kg_m2 = 0.1,
                           .theta_rad = 0.3 + 0.2 * static_cast<double>(i % 9),
                           .rate_rad_s = -1.0});
  }
  return chain;
}
// A chain of three coordinates, in a plane or in space.
inline Mechanism Arm(bool in_space = false) {
  Mechanism arm = {.mass_matrix = {2.0, 0.6, 0.1, 0.6, 1.2, 0.3, 0.1, 0.3, 0.5},
                   .jacobian = {0.9, 0.3, -0.2, 0.7, 0.6, 0.4},
                   .rates = {-1.0, 0.4, -0.5}};
  if (in_space) arm.jacobian.insert(arm.jacobian.begin() + 3, {0.1, -0.5, 0.6});
  return arm;
}
inline PlanarContact Contact() { return {2.0, 0.5, 1.0, 1.0, -1.0}; }
inline SpatialContact ContactInSpace() { return {{1.96, 0.24, 0.6, 2.96, -0.8, 1.85}, {1.0, 0.6}, -1.0}; }

// Every system but the pendulum.
inline std::vector<System> Systems() {
  const PlanarBody flat = {2.0, 0.2, 0.1, 0.3, 0.0, 0.5, 0.0};
  const SpatialBody body = {2.0, {1, 0, 0, 1, 0, 1}, {0, 0, 0.5}, {0, 0, 1}, {1, 1, 0}};
  return {Flat(),
          Body(),
          BodyPair{PlanarPair{Flat(), flat}},
          BodyPair{SpatialPair{Body(), body}},
          Chain(),
          Contact(),
          ContactInSpace(),
          Arm(),
          Arm(/*in_space=*/true)};
}

// A scene of the system with friction 0.5 and the energetic coefficient 0.5.
inline Scene With(const System& system) {
  return {.system = system, .friction = {.kinetic_coefficient = 0.5}, .restitution = EnergeticCoefficient{0.5}};
}

// A contact in space whose end recedes for coefficients that are not small: an independent Runge-Kutta method found
// that v grows up to 0.03227808 m/s in restitution, and falls through 0 where the ratio of impulses is 1.2794394307.
inline Scene WithEndThatRecedes() {
  Scene scene = With(SpatialContact{{1.2367, 0.4119, -1.6898, 3.6464, -2.9784, 3.9852}, {0.8761, -0.8394}, -0.6307});
  scene.friction.kinetic_coefficient = 1.3465;
  return scene;
}

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_SCENES_SYSTEM_SCENES_H_
