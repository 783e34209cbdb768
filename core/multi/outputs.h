// Output: a number of the answer that outcomes are compared by and that gets bounds, as a linear function of the
// contact velocity.

#ifndef RICOCHET_CORE_MULTI_OUTPUTS_H_
#define RICOCHET_CORE_MULTI_OUTPUTS_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/contact/multi_reduction.h"
#include "core/multi/energy.h"
#include "core/multi/mirror.h"
#include "ricochet/multi_contact.h"

namespace ricochet::multi {

// The change of the output by an impact is gamma times that of the contact velocity of the sorted problem, up to an
// error of `slack` sqrt(2T). An impulse that changes the output by one unit takes at least the energy 1/(2 mobility).
struct Output {
  std::string name;
  Eigen::VectorXd gamma;
  double before = 0.0;  // Its value before, in the unit of the scene.
  double slack = 0.0;
  double mobility = 0.0;
};

// The contact velocities, the velocities of the system unless they are the same, and the outputs asked for. `before`
// are the velocities of the system, and W of the sorted problem is that of the reduction divided by `w_scale`.
std::vector<Output> OutputsOf(const MultiContactRequest& request, const MultiReduction& reduction,
                              const Eigen::VectorXd& before, const SortedProblem& sorted, const EnergyMetric& metric,
                              double w_scale);

}  // namespace ricochet::multi

#endif  // RICOCHET_CORE_MULTI_OUTPUTS_H_
