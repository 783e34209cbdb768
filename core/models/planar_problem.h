// PlanarProblem: a rigid impact at one point of a plane, as every planar model, impact law and audit takes it.
//
// W is the Delassus matrix, (u0, v0) the contact velocity before along t and n, relative to the surface.
// Bad input: none gets here (core/scene/validate.h): W is semidefinite. (u0, v0) may lie beside the range of W.

#ifndef RICOCHET_CORE_MODELS_PLANAR_PROBLEM_H_
#define RICOCHET_CORE_MODELS_PLANAR_PROBLEM_H_

#include "core/contact/delassus.h"
#include "core/models/restitution_law.h"

namespace ricochet {

struct PlanarProblem {
  PlanarDelassus w;        // 1/kg; nn > 0 where the contact approaches.
  double u0 = 0.0;         // m/s
  double v0 = 0.0;         // m/s; >= 0 is separating.
  double mu = 0.0;         // Kinetic friction, >= 0.
  double mu_static = 0.0;  // >= mu
  RestitutionLaw law = RestitutionLaw::kEnergetic;
  double coefficient = 0.0;  // By that law: e, kappa or eta.
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_MODELS_PLANAR_PROBLEM_H_
