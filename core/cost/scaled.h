// Scaled: a problem with its velocities before the impact multiplied, so that a batch has problems that differ.

#ifndef RICOCHET_CORE_COST_SCALED_H_
#define RICOCHET_CORE_COST_SCALED_H_

#include <variant>

#include "ricochet/scene.h"

namespace ricochet {

// Any model's problem.
template <typename Problem>
Problem Scaled(Problem problem, double factor) {
  if constexpr (requires { problem.contact; }) {
    problem.contact = Scaled(problem.contact, factor);
  } else if constexpr (requires { problem.omega_minus; }) {
    problem.omega_minus *= factor;
  } else {
    if constexpr (requires { problem.u0 *= factor; }) {
      problem.u0 *= factor;
    } else {
      for (double& u : problem.u0) u *= factor;
    }
    problem.v0 *= factor;
  }
  return problem;
}

// A scene that can be certified: that of a pendulum or of a planar contact.
template <>
inline Scene Scaled(Scene scene, double factor) {
  if (auto* pendulum = std::get_if<Pendulum>(&scene.system)) pendulum->omega_minus_rad_s *= factor;
  if (auto* contact = std::get_if<PlanarContact>(&scene.system)) {
    contact->tangential_m_s *= factor;
    contact->normal_m_s *= factor;
  }
  return scene;
}

}  // namespace ricochet

#endif  // RICOCHET_CORE_COST_SCALED_H_
