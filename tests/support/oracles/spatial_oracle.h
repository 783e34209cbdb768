// Spatial oracle: an impact in space whose slip does not stop, in arithmetic of any precision.
//
// Keller's equations as they stand, over xi with dtau = |u| dxi, by power series of all quantities in the frame of the
// problem, the works among them: no step has a frame of its own and none is rounded to a double. Events are roots of
// the series, found by bisection and Newton's method. Shares nothing with core/ but the problem.
//
// Radii of balls are dropped from step to step; the precision of 256 bits leaves 150 of them.

#ifndef RICOCHET_TESTS_SUPPORT_ORACLES_SPATIAL_ORACLE_H_
#define RICOCHET_TESTS_SUPPORT_ORACLES_SPATIAL_ORACLE_H_

#include <array>
#include <optional>

#include "core/models/spatial/spatial.h"
#include "tests/support/oracles/arb.h"

namespace ricochet::spatial {

struct ExactImpact {
  std::array<Ball, 2> u1, f1;
  Ball v1, tau_compression, tau1;
  Ball work_normal_compression, work_normal_restitution;
  Ball work_tangential_compression, work_tangential_restitution;
  Ball energy_change;
  Ball newton, poisson, energetic, tangential;
};

// Returns nothing if slip stops, or comes so near to a stop that the series take too many steps. The problem must
// approach, slip and have friction.
std::optional<ExactImpact> SolveExactly(const Problem& problem);

// A contact that is no double, in place of that of a problem: W is 11, 12, 13, 22, 23, 33.
struct ExactContact {
  std::array<Ball, 6> w;
  std::array<Ball, 2> u0;
  Ball v0;
};
std::optional<ExactImpact> SolveExactly(const Problem& problem, const ExactContact& contact);

// A problem as hexadecimal floats, to be pasted into a test.
std::string ToString(const Problem& problem);

}  // namespace ricochet::spatial

#endif  // RICOCHET_TESTS_SUPPORT_ORACLES_SPATIAL_ORACLE_H_
