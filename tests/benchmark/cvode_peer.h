// CvodePeer: the spatial impact by SUNDIALS CVODE, for comparison with the spatial model.
//
// It integrates Keller's original equations over the normal impulse tau, together with the normal work:
//
//   d(u, v, w)/dtau = (W (f', 1), v),   f' = -mu u/|u|
//
// by Adams' formulas of variable order. Root finding finds the ends of the phases and the point where slip has nearly
// stopped. From there on the path is straight, and closed forms end it.

#ifndef RICOCHET_TESTS_BENCHMARK_CVODE_PEER_H_
#define RICOCHET_TESTS_BENCHMARK_CVODE_PEER_H_

#include <array>
#include <cstdint>
#include <memory>

#include "core/models/spatial/spatial.h"

namespace ricochet::bench {

struct PeerImpact {
  bool ended = false;  // False if CVODE gave up, or took more steps than its budget.
  std::array<double, 2> u1 = {};
  double v1 = 0.0;
  int64_t steps = 0;
  int64_t right_hand_sides = 0;
};

class CvodePeer {
 public:
  static constexpr int64_t kStepBudget = 100'000;
  // Slip below this many tolerances counts as stopped. The error of the velocities is no larger, because friction makes
  // paths converge. At 1 CVODE tends to step over the stop and to oscillate about it until its budget is spent.
  static constexpr double kStopSlip = 10.0;

  CvodePeer();
  ~CvodePeer();

  // `tolerance`, relative and absolute, is that of CVODE's local errors, in units of max(|u0|, |v0|).
  PeerImpact Solve(const spatial::Problem& problem, double tolerance);

 private:
  struct Solver;
  std::unique_ptr<Solver> solver_;
};

}  // namespace ricochet::bench

#endif  // RICOCHET_TESTS_BENCHMARK_CVODE_PEER_H_
