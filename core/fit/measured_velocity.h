// VelocityOf: the velocity of the contact after the impact of a row, if the row measured what tells it.

#ifndef RICOCHET_CORE_FIT_MEASURED_VELOCITY_H_
#define RICOCHET_CORE_FIT_MEASURED_VELOCITY_H_

#include <cstddef>
#include <optional>
#include <vector>

#include "core/fit/problem.h"
#include "ricochet/outcome.h"
#include "ricochet/scene.h"

namespace ricochet::fit {

struct MeasuredVelocity {
  ContactVelocity velocity;
  double sigma = 0.0;  // The larger one of its components.
};

// `scene` is that of the row, `sigmas` are those of all measured numbers less the predicted ones. The velocity is told
// by that of the contact, by those of all bodies or links in a plane, or by all rates of a mechanism.
std::optional<MeasuredVelocity> VelocityOf(const Problem& problem, const std::vector<double>& sigmas, size_t row,
                                           const Scene& scene);

}  // namespace ricochet::fit

#endif  // RICOCHET_CORE_FIT_MEASURED_VELOCITY_H_
