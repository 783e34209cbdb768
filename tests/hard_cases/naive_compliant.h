// Solves an impact with tangential compliance in plain doubles, as a textbook would: by sines, cosines and their
// hyperbolic kin of time, with eigenvalues as the roots of a quadratic, and with events looked for on a grid.

#ifndef RICOCHET_TESTS_HARD_CASES_NAIVE_COMPLIANT_H_
#define RICOCHET_TESTS_HARD_CASES_NAIVE_COMPLIANT_H_

#include "core/models/compliant/compliant.h"

namespace ricochet::compliant {

// The velocities are NaN if it finds no end.
struct NaiveImpact {
  Regime regime = Regime::kUnspecified;
  double u1 = 0.0, v1 = 0.0;
  double work_normal = 0.0;  // Compression and restitution.
};

// The problem must not be separating. W is taken as it stands, whatever its rank.
NaiveImpact NaiveSolve(const Problem& problem);

}  // namespace ricochet::compliant

#endif  // RICOCHET_TESTS_HARD_CASES_NAIVE_COMPLIANT_H_
