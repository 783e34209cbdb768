// Impact laws: algebraic laws that give the end of an impact from the state before it, for comparison with
// core/models/planar/planar.h. A law has one solution, several or none.
//
// The contact is planar: W = [wtt, wtn; wtn, wnn] in 1/kg, velocities (u, v) along t and n in m/s, impulses (f, tau) on
// the striking body in N s; (u1, v1) = (u0, v0) + W (f, tau1). All laws take Newton's coefficient e: v1 = -e v0.
//
//   inputs        are valid (core/scene/validate.h): finite, mu >= 0, e >= 0.
//   v0 >= 0       The contact separates: there is one solution without impulse, (u1, v1) = (u0, v0).
//   wnn <= 0      No impulse moves the contact along the normal: there is no solution.
//   rank one      u1 = u0 + (wtn/wnn)(v1 - v0), whatever the tangential impulse is.
//   no solution   The law contradicts itself: the list is empty.
//   accuracy      is a few ulp for every output; docs/theory/laws.md says of which scale. Products of three inputs must
//                 be representable, because nothing guards against overflow.

#ifndef RICOCHET_CORE_MODELS_LAWS_IMPACT_LAW_H_
#define RICOCHET_CORE_MODELS_LAWS_IMPACT_LAW_H_

#include <vector>

#include "core/models/planar_problem.h"

namespace ricochet::laws {

struct ImpactSolution {
  double f = 0.0;     // Total tangential impulse, N s.
  double tau1 = 0.0;  // Total normal impulse, N s.
  double u1 = 0.0;    // m/s
  double v1 = 0.0;
  double energy_change = 0.0;  // E+ - E- = (f (u0 + u1) + tau1 (v0 + v1))/2, J; positive if the law creates energy.
};

struct ImpactLawResult {
  std::vector<ImpactSolution> solutions;
  // Where every mixture of two solutions is one, too: the two ends of that range, or one if it has no other end.
  std::vector<ImpactSolution> ends;
};

}  // namespace ricochet::laws

#endif  // RICOCHET_CORE_MODELS_LAWS_IMPACT_LAW_H_
