// The pendulum's geometry in Wide arithmetic, for everything that is computed once a request: bounds, histories and
// first-order forms.

#ifndef RICOCHET_CORE_MODELS_PENDULUM_WIDE_H_
#define RICOCHET_CORE_MODELS_PENDULUM_WIDE_H_

#include "core/models/pendulum/kernel-inl.h"
#include "core/models/pendulum/pendulum.h"
#include "core/numerics/wide.h"

namespace ricochet::pendulum {

using WideSolution = HWY_NAMESPACE::Solution<Wide, bool>;

// Computes s, d, q and locked; all other members are not set.
inline WideSolution SolveGeometry(const Problem& problem) {
  WideSolution x;
  HWY_NAMESPACE::SolveGeometry(HWY_NAMESPACE::MakeInputs<Wide>(problem), x);
  return x;
}

}  // namespace ricochet::pendulum

#endif  // RICOCHET_CORE_MODELS_PENDULUM_WIDE_H_
