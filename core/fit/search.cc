#include "core/fit/search.h"

#include <ceres/cost_function.h>
#include <ceres/evaluation_callback.h>
#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>

namespace ricochet::fit {
namespace {

std::unique_ptr<ceres::LossFunction> MakeLoss(const Problem& problem) {
  switch (problem.loss) {
    case FitLoss::kHuber:
      return std::make_unique<ceres::HuberLoss>(problem.loss_scale);
    case FitLoss::kCauchy:
      return std::make_unique<ceres::CauchyLoss>(problem.loss_scale);
    case FitLoss::kUnspecified:
    case FitLoss::kSquares:
      break;
  }
  return std::make_unique<ceres::TrivialLoss>();
}

// Evaluates all rows at once before Ceres asks for its residuals one by one. Ceres moves the unknowns over their
// scales, so that its tolerances mean the same for each.
class Evaluation final : public ceres::EvaluationCallback {
 public:
  Evaluation(const std::vector<double>& start, const std::vector<bool>& is_free, Model& model)
      : model_(model), start_(start), is_free_(is_free), scaled_(start) {
    for (size_t k = 0; k < start.size(); ++k) scaled_[k] /= model.problem().scale[k];
  }

  double& scaled(size_t k) { return scaled_[k]; }

  std::vector<double> unknowns() const {
    const Problem& problem = model_.problem();
    std::vector<double> at = start_;
    for (size_t k = 0; k < at.size(); ++k) {
      // The product may round beyond a bound. What has not moved keeps its bits.
      if (scaled_[k] == start_[k] / problem.scale[k]) continue;
      at[k] = std::clamp(scaled_[k] * problem.scale[k], problem.low[k], problem.high[k]);
    }
    return at;
  }

  void PrepareForEvaluation(bool evaluate_jacobians, bool new_evaluation_point) override {
    const std::vector<double> at = unknowns();
    if (new_evaluation_point) is_good_ = model_.Predict(at, predicted_);
    if (!is_good_ || !evaluate_jacobians || model_.Differentiate(at, is_free_, derivatives_)) return;
    // The fit was stopped. Without slopes the search ends at once, and Ceres writes no complaint to standard error.
    derivatives_.assign(predicted_.size() * at.size(), 0.0);
  }

  bool Get(size_t i, double& residual, double** slopes) const {
    if (!is_good_) return false;
    const Number& number = model_.problem().numbers[i];
    residual = (number.value - predicted_[i]) / number.sigma;
    for (size_t k = 0; slopes != nullptr && k < scaled_.size(); ++k) {
      if (slopes[k] == nullptr) continue;
      *slopes[k] = -derivatives_[i * scaled_.size() + k] * model_.problem().scale[k] / number.sigma;
    }
    return true;
  }

 private:
  Model& model_;
  const std::vector<double>& start_;
  const std::vector<bool>& is_free_;
  std::vector<double> scaled_;
  std::vector<double> predicted_, derivatives_;
  bool is_good_ = false;
};

class Residual final : public ceres::CostFunction {
 public:
  Residual(size_t i, size_t unknowns, const Evaluation& evaluation) : i_(i), evaluation_(evaluation) {
    set_num_residuals(1);
    mutable_parameter_block_sizes()->assign(unknowns, 1);
  }
  bool Evaluate(double const* const* /*scaled*/, double* residual, double** slopes) const override {
    return evaluation_.Get(i_, *residual, slopes);
  }

 private:
  size_t i_;
  const Evaluation& evaluation_;
};

ceres::Solver::Options OptionsOf(int32_t iterations, double tolerance) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = iterations;
  options.function_tolerance = tolerance;
  // Beyond these a step changes the unknowns by their rounding alone.
  options.gradient_tolerance = 1e-14;
  options.parameter_tolerance = 1e-12;
  // Along a step that meets a bound, cubic interpolation would ask for derivatives at every place that it tries.
  options.line_search_interpolation_type = ceres::BISECTION;
  options.max_num_line_search_step_size_iterations = 5;
  // Steps that leave the rules of the scene are shortened until they keep them.
  options.max_num_consecutive_invalid_steps = 50;
  return options;
}

void Build(Evaluation& evaluation, const std::vector<bool>& is_free, const Model& model, ceres::Problem& built) {
  const Problem& problem = model.problem();
  std::vector<double*> blocks;
  for (size_t k = 0; k < problem.unknowns(); ++k) {
    blocks.push_back(&evaluation.scaled(k));
    built.AddParameterBlock(blocks[k], 1);
    if (!is_free[k]) {
      built.SetParameterBlockConstant(blocks[k]);
      continue;
    }
    if (std::isfinite(problem.low[k])) built.SetParameterLowerBound(blocks[k], 0, problem.low[k] / problem.scale[k]);
    if (std::isfinite(problem.high[k])) built.SetParameterUpperBound(blocks[k], 0, problem.high[k] / problem.scale[k]);
  }
  for (size_t i = 0; i < problem.numbers.size(); ++i) {
    built.AddResidualBlock(std::make_unique<Residual>(i, blocks.size(), evaluation).release(),
                           MakeLoss(problem).release(), blocks);
  }
}

double ObjectiveAt(const std::vector<double>& at, Model& model) {
  std::vector<double> predicted;
  if (!model.Predict(at, predicted)) return std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (size_t i = 0; i < predicted.size(); ++i) {
    const Number& number = model.problem().numbers[i];
    const double residual = (number.value - predicted[i]) / number.sigma;
    sum += LossOf(model.problem(), residual * residual).loss;
  }
  return sum;
}

}  // namespace

Loss LossOf(const Problem& problem, double squared_residual) {
  std::array<double, 3> loss = {};
  MakeLoss(problem)->Evaluate(squared_residual, loss.data());
  return {.loss = loss[0], .weight = loss[1]};
}

namespace {

// Ceres projects its steps onto the bounds and then creeps along them. After so many iterations the search goes on
// without the unknowns that a bound holds.
constexpr int32_t kBurst = 10;
// An unknown is at a bound if it is nearer than this part of its scale.
constexpr double kAtBound = 1e-12;

// The free unknowns but for those that the objective pushes against a bound.
std::vector<bool> Movable(const std::vector<double>& at, const std::vector<bool>& is_free, Model& model) {
  const Problem& problem = model.problem();
  const auto is_at = [&](size_t k, double bound) { return std::fabs(at[k] - bound) <= kAtBound * problem.scale[k]; };
  std::vector<bool> bound = is_free;
  for (size_t k = 0; k < at.size(); ++k)
    bound[k] = is_free[k] && (is_at(k, problem.low[k]) || is_at(k, problem.high[k]));
  std::vector<bool> movable = is_free;
  std::vector<double> predicted, slopes;
  const bool is_bound = std::find(bound.begin(), bound.end(), true) != bound.end();
  if (!is_bound || !model.Predict(at, predicted) || !model.Differentiate(at, bound, slopes)) return movable;
  for (size_t k = 0; k < at.size(); ++k) {
    double push = 0.0;  // Towards higher values.
    for (size_t i = 0; i < predicted.size(); ++i) {
      const Number& number = problem.numbers[i];
      const double residual = (number.value - predicted[i]) / number.sigma;
      push += LossOf(problem, residual * residual).weight * residual * slopes[i * at.size() + k] / number.sigma;
    }
    if (bound[k]) movable[k] = is_at(k, push < 0.0 ? problem.high[k] : problem.low[k]);
  }
  return movable;
}

// Goes on from `minimum` for some iterations, and returns whether the search converged.
bool Burst(const std::vector<bool>& is_free, int32_t iterations, double tolerance, Model& model, Minimum& minimum) {
  Evaluation evaluation(minimum.at, is_free, model);
  ceres::Problem::Options options;
  options.evaluation_callback = &evaluation;
  ceres::Problem built(options);
  Build(evaluation, is_free, model, built);
  ceres::Solver::Summary summary;
  ceres::Solve(OptionsOf(iterations, tolerance), &built, &summary);
  minimum.iterations += std::max(summary.num_successful_steps + summary.num_unsuccessful_steps, 1);
  const std::vector<double> end = evaluation.unknowns();
  const double objective = ObjectiveAt(end, model);
  if (objective <= minimum.objective) {
    minimum.at = end;
    minimum.objective = objective;
  }
  return summary.termination_type == ceres::CONVERGENCE;
}

}  // namespace

Minimum Minimize(const std::vector<double>& start, const std::vector<bool>& is_free, double tolerance, Model& model) {
  Minimum minimum = {.at = start, .objective = ObjectiveAt(start, model)};
  std::vector<bool> moves = is_free;
  const int32_t most = model.problem().max_iterations;
  while (std::isfinite(minimum.objective) && !minimum.converged && minimum.iterations < most && !model.is_stopped()) {
    const bool has_free = std::find(moves.begin(), moves.end(), true) != moves.end();
    const int32_t left = std::min(kBurst, most - minimum.iterations);
    const bool ended = !has_free || Burst(moves, left, tolerance, model, minimum);
    const std::vector<bool> movable = Movable(minimum.at, is_free, model);
    minimum.converged = ended && movable == moves;
    moves = movable;
  }
  return minimum;
}

}  // namespace ricochet::fit
