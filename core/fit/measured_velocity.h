// VelocityOf: the velocity of the contact after the impact of a row, if the row measured enough to tell it.

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

// `scene` is that of the row; `sigmas` belong to all measured numbers minus the predicted ones. The velocity follows
// from that of the contact, from those of all bodies or links in a plane, or from all rates of a mechanism.
std::optional<MeasuredVelocity> VelocityOf(const Problem& problem, const std::vector<double>& sigmas, size_t row,
                                           const Scene& scene);

}  // namespace ricochet::fit

#endif  // RICOCHET_CORE_FIT_MEASURED_VELOCITY_H_
