// Arithmetic: solves an impact in closed form by the cheapest arithmetic that is exact enough.
//
// Plain double arithmetic serves if it proves the regime, the order of the events and the broken limits, and if the
// bound on its rounding error is within the part of the tolerance that the plan has left. Otherwise, and at tolerance
// 0, compensated (double-double) arithmetic answers. The bound is relative, and covers with one number
//
//   each velocity of the contact                       over V = max(|u0|, |v0|)
//   each impulse times its mobility, Wnn tau, Wtt f    over V
//   each work and the change of energy                 over the sum of the magnitudes of the four works
//
// A pendulum's coefficients are covered, too: kappa_hat, kappa and eta over their own value, mu_hat over mu. Those of a
// planar contact follow from the errors above (docs/theory/rounding_planar.md). A number below the smallest normal
// double may err by 2^-1074 besides. The problem must be valid.

#ifndef RICOCHET_CORE_PLAN_ARITHMETIC_H_
#define RICOCHET_CORE_PLAN_ARITHMETIC_H_

#include "core/models/impact_errors.h"
#include "core/models/pendulum/pendulum.h"
#include "core/models/planar/planar.h"
#include "ricochet/plan.h"

namespace ricochet {

template <typename Impact>
struct SolvedImpact {
  Impact impact;
  // Its bound, which is always there, exceeds the tolerance only in compensated arithmetic.
  PlannedArithmetic arithmetic;
  ImpactErrors errors;  // of each number

  double relative_error() const { return arithmetic.rounding_error.value_or(0.0); }
};

// True for the models of SolveWithin.
inline bool HasChoiceOfArithmetic(Model model) { return model == Model::kPendulum || model == Model::kPlanar; }

// `tolerance` is what ToleranceLeft gives. pendulum::SolveColumns gives the same bits in SIMD lanes.
SolvedImpact<pendulum::Impact> SolveWithin(const pendulum::Problem& problem, double tolerance);
SolvedImpact<planar::Impact> SolveWithin(const planar::Problem& problem, double tolerance);

// The part of a tolerance that is left for rounding when effects of size `neglected` are left out: at least 0. A bound
// up to it plus `neglected`, rounded, does not exceed the tolerance.
double ToleranceLeft(double relative_tolerance, double neglected);

}  // namespace ricochet

#endif  // RICOCHET_CORE_PLAN_ARITHMETIC_H_
