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
#include "ricochet/scene.h"

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
  // If every mixture of two solutions is a solution, these are the ends of the range; there may be one end only.
  std::vector<ImpactSolution> ends;
};

// Each law needs e >= 0. Its source file states its equations.

// There is one solution, or none if wnn - mu sgn(u0) wtn <= 0, because no tau1 > 0 then ends the approach
// (self-locking).
ImpactLawResult SolveWhittaker(const PlanarProblem& input, double e);

// Where a range of impulses solves the law, the solution is the end whose friction does the least work: it opposes the
// slip.
ImpactLawResult SolveKaneLevinson(const PlanarProblem& input, double e);

// There is one solution, or none if wnn + mu_hat wtn <= 0.
ImpactLawResult SolveBrach(const PlanarProblem& input, double e, double mu_hat);

// e_t must be in [-1, 1]. There is exactly one solution, or none if wnn <= 0 or if, at rank one and beside the range of
// W, friction drives the contact in.
ImpactLawResult SolveChatterjeeRuina(const PlanarProblem& input, double e, double e_t);

// Solves an impact by the law that is set. It has no solution if none is.
ImpactLawResult SolveLaw(const ImpactLaw& law, const PlanarProblem& problem);

// Estimates the error of the velocities of a solution, over max(|u0|, |v0|).
double RelativeErrorOf(const ImpactLaw& law, const PlanarProblem& problem, const ImpactSolution& solution);

}  // namespace ricochet::laws

#endif  // RICOCHET_CORE_MODELS_LAWS_IMPACT_LAW_H_
