// ModelsOfPendulum: which of many rigid pendulums are surely valid, approach and have friction, in SIMD lanes. Where
// the demand is a tolerance alone, the closed form answers them (ModelOfPendulum in core/plan/choose.h).

#ifndef RICOCHET_CORE_PLAN_PENDULUM_MODELS_H_
#define RICOCHET_CORE_PLAN_PENDULUM_MODELS_H_

#include "absl/types/span.h"
#include "core/models/pendulum/columns.h"
#include "ricochet/plan.h"

namespace ricochet {

// Looks at the problems [0, models.size()), whose numbers may be anything. A model is kPendulum if the problem is
// valid, its numbers lie in [2^-100, 2^100], and ModelOfPendulum gives kPendulum; else it is kUnspecified, and the
// problem has to be checked and asked for alone. Returns true if all are kPendulum.
bool ModelsOfPendulum(const pendulum::ProblemColumns& problems, absl::Span<Model> models);

}  // namespace ricochet

#endif  // RICOCHET_CORE_PLAN_PENDULUM_MODELS_H_
