// An impact with tangential compliance in arithmetic of any precision: the oracle of core/models/compliant.
//
// Between events the equations are linear in time, x' = M x for x = (u, v, n, p, tau, f), whether the particle slides
// or sticks: x(t) = exp(M t) x(0) by its Taylor series, in steps no longer than a radian of the fastest oscillation. So
// every event is a root of a polynomial on [0, 1], and the first is found by halving until interval arithmetic shows
// either that there is none or that the polynomial is monotonic. Zeros at t = 0, the beginning of a stick or a turn,
// are divided out. No sine, square root or eigenvalue, and no normal impulse in place of time: shares nothing with
// core/ but the problem and the modes' names.
//
// Radii of balls are dropped from step to step, for in the directions of x they would grow without reason: compare two
// precisions. What is below 2^(-bits/2) of its terms counts as 0.

#ifndef RICOCHET_TESTS_SUPPORT_ORACLES_COMPLIANT_ORACLE_H_
#define RICOCHET_TESTS_SUPPORT_ORACLES_COMPLIANT_ORACLE_H_

#include <string>
#include <vector>

#include "core/models/compliant/compliant.h"
#include "tests/support/oracles/arb.h"

namespace ricochet::compliant {

struct ExactImpact {
  bool ends = false;  // Else nothing of the end is known.
  Regime regime = Regime::kUnspecified;
  std::vector<Section> sections;  // Numbers rounded.
  Ball u1, v1;
  Ball tau_compression, tau1, f_compression, f1;
  Ball work_normal_compression, work_normal_restitution, work_normal;
  Ball energy_change;
  Ball spring_energy;
  Ball friction_dissipation;  // The part of the energy lost that is neither normal work nor the spring's.
};

// The problem must not be separating.
ExactImpact SolveExactly(const Problem& problem, slong bits = 192);

// The error of the velocities over max(|u0|, |v0|).
double VelocityError(const Problem& problem, double u1, double v1, const ExactImpact& exact);

// A problem as hexadecimal floats, to be pasted into a test.
std::string ToString(const Problem& problem);

}  // namespace ricochet::compliant

#endif  // RICOCHET_TESTS_SUPPORT_ORACLES_COMPLIANT_ORACLE_H_
