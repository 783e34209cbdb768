// A contact in space written as W, velocities and friction, for tests that state one by its numbers.

#ifndef RICOCHET_TESTS_SUPPORT_SCENES_SPATIAL_CONTACT_H_
#define RICOCHET_TESTS_SUPPORT_SCENES_SPATIAL_CONTACT_H_

#include <array>

#include "core/models/restitution_law.h"
#include "core/models/spatial/spatial.h"

namespace ricochet::spatial {

// Rest says what a contact does after compression, and how precisely its impact is wanted; by default as in Problem.
struct Rest {
  RestitutionLaw law = Problem().law;
  double coefficient = Problem().coefficient;
  double tolerance = Problem().tolerance;
};

// W is (11, 12, 13, 22, 23, 33); one coefficient of friction holds for slip and for stick.
inline Problem Contact(const std::array<double, 6>& w, const std::array<double, 2>& u0, double v0, double mu,
                       const Rest& rest = {}) {
  return {.w11 = w[0],
          .w12 = w[1],
          .w13 = w[2],
          .w22 = w[3],
          .w23 = w[4],
          .w33 = w[5],
          .u0 = u0,
          .v0 = v0,
          .mu = mu,
          .mu_static = mu,
          .law = rest.law,
          .coefficient = rest.coefficient,
          .tolerance = rest.tolerance};
}

}  // namespace ricochet::spatial

#endif  // RICOCHET_TESTS_SUPPORT_SCENES_SPATIAL_CONTACT_H_
