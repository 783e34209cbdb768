#include "core/multi/outputs.h"

#include <utility>

#include "core/types/multi_contact.h"

namespace ricochet::multi {
namespace {

class Maker {
 public:
  Maker(const MultiReduction& reduction, const Eigen::VectorXd& before, const SortedProblem& sorted,
        const EnergyMetric& metric, double w_scale)
      : reduction_(reduction), before_(before), sorted_(sorted), metric_(metric), w_scale_(w_scale) {}

  void AddContacts() {
    const Problem& problem = sorted_.problem;
    const Eigen::VectorXd velocity = reduction_.ContactVelocity(before_);
    const std::vector<std::string> names = ContactOutputNames(static_cast<size_t>(problem.k), problem.d);
    for (int row = 0; row < velocity.size(); ++row) {
      Output& output = outputs_.emplace_back();
      output.name = names[static_cast<size_t>(row)];
      output.gamma = sorted_.FromScene(Eigen::VectorXd::Unit(velocity.size(), row));
      output.before = velocity(row);
      output.mobility = output.gamma.dot(problem.w * output.gamma);
    }
  }

  // Adds coefficients . q'. An impulse p changes it by driven . p, and that is gamma . W p.
  void AddVelocity(const std::string& name, const Eigen::VectorXd& coefficients) {
    const Eigen::VectorXd driven = sorted_.FromScene(reduction_.response.transpose() * coefficients / w_scale_);
    Eigen::VectorXd of_pivots(static_cast<Eigen::Index>(metric_.pivots.size()));
    const auto solve = [&](const Eigen::VectorXd& right) {
      for (Eigen::Index c = 0; c < of_pivots.size(); ++c) {
        const int row = metric_.pivots[static_cast<size_t>(c)];
        of_pivots(c) = (right(row) - metric_.g.row(row).head(c).dot(of_pivots.head(c))) / metric_.g(row, c);
      }
    };
    solve(driven);
    Output& output = outputs_.emplace_back();
    output.name = name;
    output.gamma = metric_.ImpulseFor(of_pivots);
    output.before = coefficients.dot(before_);
    output.mobility = of_pivots.squaredNorm();
    const double rounding = 16.0 * kEpsilon * static_cast<double>(of_pivots.size()) * of_pivots.norm();
    solve(driven - sorted_.problem.w * output.gamma);
    // The velocity moves by at most 2 sqrt(2T) in the metric of energy.
    output.slack = 2.0 * (2.0 * of_pivots.norm() + rounding);
  }

  std::vector<Output> outputs() && { return std::move(outputs_); }

 private:
  const MultiReduction& reduction_;
  const Eigen::VectorXd& before_;
  const SortedProblem& sorted_;
  const EnergyMetric& metric_;
  const double w_scale_;
  std::vector<Output> outputs_;
};

}  // namespace

std::vector<Output> OutputsOf(const MultiContactRequest& request, const MultiReduction& reduction,
                              const Eigen::VectorXd& before, const SortedProblem& sorted, const EnergyMetric& metric,
                              double w_scale) {
  Maker maker(reduction, before, sorted, metric, w_scale);
  maker.AddContacts();
  const std::vector<std::string> names = SystemOutputNames(request.scene.system, reduction.directions);
  for (size_t i = 0; i < names.size(); ++i) {
    maker.AddVelocity(names[i], Eigen::VectorXd::Unit(before.size(), static_cast<Eigen::Index>(i)));
  }
  for (const LinearOutput& output : request.outputs) {
    maker.AddVelocity(output.name, Eigen::Map<const Eigen::VectorXd>(output.coefficients.data(), before.size()));
  }
  return std::move(maker).outputs();
}

}  // namespace ricochet::multi
