// What every comparison law takes and gives: one algebraic answer, or several, or none, from the state before impact.
//
// The contact is planar: W = [wtt, wtn; wtn, wnn], symmetric positive semidefinite, in 1/kg; velocities (u, v) along
// the tangent and the normal in m/s; impulses (f, tau) on the striking body in N s; (u1, v1) = (u0, v0) + W (f, tau1).
// All of these laws take Newton's coefficient e: tau1 follows from v1 = -e v0, whatever friction does and whatever
// energy that asks for. They are here to be compared with core/models/planar/planar.h, and are named after those who stated
// them.
//
// Common to all of them:
//   inputs        finite; mu >= 0, e >= 0; W semidefinite and, where its rank is one, (u0, v0) in its range. The caller
//                 has checked that (core/scene/validate.h).
//   v0 >= 0       the contact separates: one solution, without impulse, (u1, v1) = (u0, v0).
//   wnn <= 0      the contact cannot be moved along the normal: no solution.
//   rank one      det W <= 4 eps wtt wnn: u follows v, u1 = u0 + (wtn/wnn)(v1 - v0), whatever the tangential impulse.
//   no solution   an empty list: the law contradicts itself there. Never an exception, never a made-up answer.
//   accuracy      v1 is rounded once. Impulses carry a few ulp each, whatever det W; only where Chatterjee and Ruina's
//                 law stays inside the cone, tau1 carries a few ulp of |f wtn|/wnn too. u1: a few ulp of the largest
//                 of |u0|, |v0 wtn|/wnn and |wtn tau1 + wtt f|. energy_change: of the larger of its two terms.
//                 No guard against overflow: products of three inputs must be representable.

#ifndef RICOCHET_CORE_MODELS_LAWS_IMPACT_LAW_H_
#define RICOCHET_CORE_MODELS_LAWS_IMPACT_LAW_H_

#include <vector>

namespace ricochet::laws {

struct PlanarImpactInput {
  double wtt = 0.0;  // 1/kg
  double wtn = 0.0;
  double wnn = 0.0;
  double u0 = 0.0;  // m/s
  double v0 = 0.0;
  double mu = 0.0;
};

struct ImpactSolution {
  double f = 0.0;     // Total tangential impulse, N s.
  double tau1 = 0.0;  // Total normal impulse, N s.
  double u1 = 0.0;    // m/s
  double v1 = 0.0;
  double energy_change = 0.0;  // E+ - E- = (f (u0 + u1) + tau1 (v0 + v1))/2, J; positive if the law creates energy.
};

struct ImpactLawResult {
  std::vector<ImpactSolution> solutions;
};

}  // namespace ricochet::laws

#endif  // RICOCHET_CORE_MODELS_LAWS_IMPACT_LAW_H_
