// Contacts whose numbers several tests know, and conversions of a contact to another model.

#ifndef RICOCHET_TESTS_SUPPORT_SCENES_KNOWN_CONTACTS_H_
#define RICOCHET_TESTS_SUPPORT_SCENES_KNOWN_CONTACTS_H_

#include "core/models/pendulum/pendulum.h"
#include "core/models/planar/planar.h"
#include "core/models/restitution_law.h"
#include "core/models/spatial/spatial.h"

namespace ricochet {

// A uniform rod at 45 degrees that strikes with its end, m = l = 1; mu = 0.7.
inline planar::Problem FortyFiveDegreeRod(RestitutionLaw law = RestitutionLaw::kEnergetic, double coefficient = 0.0) {
  return {.w = {2.5, 1.5, 2.5},
          .u0 = -1.0,
          .v0 = -1.0,
          .mu = 0.7,
          .mu_static = 0.7,
          .law = law,
          .coefficient = coefficient};
}

// A contact whose slip turns: W positive definite, wtn along no axis.
inline spatial::Problem TurningContact(double u1, double u2, double mu) {
  return {.w11 = 1.96,
          .w12 = 0.24,
          .w13 = 0.6,
          .w22 = 2.96,
          .w23 = -0.8,
          .w33 = 1.85,
          .u0 = {u1, u2},
          .v0 = -1.0,
          .mu = mu,
          .mu_static = mu};
}

// The contact of a pendulum. W has rank one up to rounding.
inline planar::Problem ContactOf(const pendulum::Problem& p) {
  return {.w = {p.b * p.b / p.inertia, p.a * p.b / p.inertia, p.a * p.a / p.inertia},
          .u0 = p.b * p.omega_minus,
          .v0 = p.a * p.omega_minus,
          .mu = p.mu,
          .mu_static = p.mu_static,
          .law = p.law,
          .coefficient = p.coefficient};
}

// A contact in space with its second direction left out.
inline planar::Problem InPlane(const spatial::Problem& p) {
  return {.w = {p.w11, p.w13, p.w33},
          .u0 = p.u0[0],
          .v0 = p.v0,
          .mu = p.mu,
          .mu_static = p.mu_static,
          .law = p.law,
          .coefficient = p.coefficient};
}

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_SCENES_KNOWN_CONTACTS_H_
