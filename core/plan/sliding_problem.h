// SlidingProblemOf: the same contact for the models whose slip neither stops nor turns.

#ifndef RICOCHET_CORE_PLAN_SLIDING_PROBLEM_H_
#define RICOCHET_CORE_PLAN_SLIDING_PROBLEM_H_

#include "core/models/planar/planar.h"
#include "core/models/sliding/sliding.h"
#include "core/models/spatial/spatial.h"

namespace ricochet {

inline sliding::Problem<1> SlidingProblemOf(const planar::Problem& problem) {
  return {.w = {problem.w.tt, problem.w.tn, problem.w.nn},
          .u0 = {problem.u0},
          .v0 = problem.v0,
          .mu = problem.mu,
          .coefficient = problem.coefficient};
}

inline sliding::Problem<2> SlidingProblemOf(const spatial::Problem& problem) {
  return {.w = {problem.w11, problem.w12, problem.w13, problem.w22, problem.w23, problem.w33},
          .u0 = problem.u0,
          .v0 = problem.v0,
          .mu = problem.mu,
          .coefficient = problem.coefficient};
}

}  // namespace ricochet

#endif  // RICOCHET_CORE_PLAN_SLIDING_PROBLEM_H_
