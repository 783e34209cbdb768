// The pendulum's geometry in Wide arithmetic, for what is solved once a request: bounds, histories, first-order forms.

#ifndef RICOCHET_CORE_MODELS_PENDULUM_WIDE_H_
#define RICOCHET_CORE_MODELS_PENDULUM_WIDE_H_

#include "core/models/pendulum/kernel-inl.h"
#include "core/models/pendulum/pendulum.h"
#include "core/numerics/wide.h"

namespace ricochet::pendulum {

using WideSolution = HWY_NAMESPACE::Solution<Wide, bool>;

// s, d, q and locked; the rest is not set.
inline WideSolution SolveGeometry(const Problem& problem) {
  WideSolution x;
  HWY_NAMESPACE::SolveGeometry(HWY_NAMESPACE::MakeInputs<Wide>(problem), x);
  return x;
}

// Everything. The problem must not be separating.
inline WideSolution SolveAll(const Problem& problem) {
  WideSolution x;
  HWY_NAMESPACE::SolveParts(problem.law, HWY_NAMESPACE::MakeInputs<Wide>(problem), kPartAll, x);
  return x;
}

}  // namespace ricochet::pendulum

#endif  // RICOCHET_CORE_MODELS_PENDULUM_WIDE_H_
