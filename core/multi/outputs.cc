#include "core/multi/outputs.h"

#include "core/types/multi_contact.h"

namespace ricochet::multi {

std::vector<Output> OutputsOf(const MultiContactRequest& request, const MultiReduction& reduction,
                              const Eigen::VectorXd& before, const SortedProblem& sorted, const EnergyMetric& metric,
                              double w_scale) {
  const Problem& problem = sorted.problem;
  std::vector<Output> outputs;
  const Eigen::VectorXd contact_velocity = reduction.ContactVelocity(before);
  std::vector<std::string> names = ContactOutputNames(static_cast<size_t>(problem.k), problem.d);
  for (int row = 0; row < contact_velocity.size(); ++row) {
    Output& output = outputs.emplace_back();
    output.name = names[At(row)];
    output.gamma = sorted.FromScene(Eigen::VectorXd::Unit(contact_velocity.size(), row));
    output.before = contact_velocity(row);
    output.mobility = output.gamma.dot(problem.w * output.gamma);
  }
  // Adds coefficients . q'. An impulse p changes it by driven . p, and that is gamma . W p.
  const auto add = [&](const std::string& name, const Eigen::VectorXd& coefficients) {
    const Eigen::VectorXd driven = sorted.FromScene(reduction.response.transpose() * coefficients / w_scale);
    const Eigen::VectorXd coordinates = metric.CoordinatesOf(driven);
    Output& output = outputs.emplace_back();
    output.name = name;
    output.gamma = metric.ImpulseFor(coordinates);
    output.before = coefficients.dot(before);
    output.mobility = coordinates.squaredNorm();
    const double rounding = 16.0 * kEpsilon * static_cast<double>(coordinates.size()) * coordinates.norm();
    const double beside = metric.CoordinatesOf(driven - problem.w * output.gamma).norm();
    // The velocity moves by at most 2 sqrt(2T) in the metric of energy.
    output.slack = 2.0 * (2.0 * beside + rounding);
  };
  names = SystemOutputNames(request.scene.system, reduction.directions);
  for (size_t i = 0; i < names.size(); ++i) {
    add(names[i], Eigen::VectorXd::Unit(before.size(), static_cast<Eigen::Index>(i)));
  }
  for (const LinearOutput& output : request.outputs) {
    add(output.name, Eigen::Map<const Eigen::VectorXd>(output.coefficients.data(), before.size()));
  }
  return outputs;
}

}  // namespace ricochet::multi
