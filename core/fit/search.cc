#include "core/fit/search.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <unsupported/Eigen/LevenbergMarquardt>

#include "core/numerics/elementary.h"

namespace ricochet::fit {
namespace {

using Eigen::Index;

// ln(1 + x), exact for small x too: what rounding takes from 1 + x it takes from the factor as well (Kahan).
double LogOfOnePlus(double x) {
  const double sum = 1.0 + x;
  return sum == 1.0 ? x : Log(sum) * (x / (sum - 1.0));
}

// Costed holds a residual whose square is its loss, and its derivative by the original residual.
struct Costed {
  double residual = 0.0;
  double slope = 1.0;
};

Costed CostOf(const Problem& problem, double residual) {
  const Loss loss = LossOf(problem, residual * residual);
  const double root = std::sqrt(loss.loss);
  if (!(root > 0.0)) return {.residual = residual, .slope = 1.0};
  return {.residual = std::copysign(root, residual), .slope = loss.weight * std::fabs(residual) / root};
}

// The costed residuals over the free unknowns, which move over their scales so that tolerances mean the same for each.
// Beyond a bound an unknown has the value of the bound, and nothing depends on it.
class Residuals : public Eigen::DenseFunctor<double> {
 public:
  Residuals(const std::vector<double>& start, const std::vector<size_t>& free, Model& model)
      : DenseFunctor(static_cast<int>(free.size()), static_cast<int>(model.problem().residuals())),
        model_(model),
        problem_(model.problem()),
        start_(start),
        free_(free),
        is_free_(start.size(), false) {
    for (const size_t k : free) is_free_[k] = true;
  }

  Eigen::VectorXd Scaled(const std::vector<double>& at) const {
    Eigen::VectorXd x(inputs());
    for (Index i = 0; i < x.size(); ++i) x[i] = at[Free(i)] / problem_.scale[Free(i)];
    return x;
  }
  std::vector<double> Unknowns(const Eigen::VectorXd& x) const {
    std::vector<double> at = start_;
    for (Index i = 0; i < x.size(); ++i) {
      const size_t k = Free(i);
      // The product may round beyond a bound, hence the clamp. An unknown that has not moved keeps its bits.
      if (x[i] == start_[k] / problem_.scale[k]) continue;
      at[k] = std::clamp(x[i] * problem_.scale[k], problem_.low[k], problem_.high[k]);
    }
    return at;
  }

  // If an impact lacks a measured number, the residuals are set so large that the search turns back.
  int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& residuals) const {
    constexpr double kTurnsBack = 1e100;
    if (!model_.Residuals(Unknowns(x), residuals_)) {
      residuals.setConstant(kTurnsBack);
      has_turned_back_ = true;
      return 0;
    }
    for (Index i = 0; i < residuals.size(); ++i) residuals[i] = CostedAt(i).residual;
    return 0;
  }

  bool has_turned_back() const { return has_turned_back_; }

  int df(const Eigen::VectorXd& x, Eigen::MatrixXd& slopes) const {
    const std::vector<double> at = Unknowns(x);
    std::vector<double> of_residuals;
    slopes.setZero(values(), inputs());
    // A fit that was stopped gets no slopes, which ends the search at once.
    if (!model_.Residuals(at, residuals_) || !model_.Slopes(at, is_free_, of_residuals)) return 0;
    for (Index j = 0; j < slopes.cols(); ++j) {
      const size_t k = Free(j);
      if (IsBeyond(x[j] * problem_.scale[k], k)) continue;
      for (Index i = 0; i < std::ssize(problem_.numbers); ++i) {
        slopes(i, j) = CostedAt(i).slope * of_residuals[static_cast<size_t>(i) * at.size() + k] * problem_.scale[k];
      }
    }
    return 0;
  }

 private:
  size_t Free(Index i) const { return free_[static_cast<size_t>(i)]; }
  Costed CostedAt(Index i) const { return CostOf(problem_, residuals_[static_cast<size_t>(i)]); }
  bool IsBeyond(double value, size_t k) const { return value < problem_.low[k] || value > problem_.high[k]; }

  Model& model_;
  const Problem& problem_;
  const std::vector<double>& start_;
  const std::vector<size_t>& free_;
  std::vector<bool> is_free_;
  mutable std::vector<double> residuals_;
  mutable bool has_turned_back_ = false;
};

double ObjectiveOf(const Problem& problem, const std::vector<double>& residuals) {
  double sum = 0.0;
  for (const double residual : residuals) {
    if (!std::isfinite(residual)) return std::numeric_limits<double>::infinity();
    sum += LossOf(problem, residual * residual).loss;
  }
  return sum;
}

struct Step {
  bool is_at_bound = false;      // The minimum is better by more than the tolerance, and lies at a bound.
  bool has_turned_back = false;  // The search met a place without predictions.
};

// Runs one search from the best minimum so far, which it replaces if it finds a better one.
Step Search(const std::vector<size_t>& free, double tolerance, Model& model, Minimum& minimum) {
  const std::vector<double> start = minimum.at;
  const double before = minimum.objective;
  Residuals residuals(start, free, model);
  Eigen::LevenbergMarquardt<Residuals> search(residuals);
  search.setFtol(tolerance);
  // Below these tolerances a step changes the unknowns by their rounding alone.
  search.setXtol(1e-12);
  search.setGtol(1e-14);
  search.setMaxfev(model.problem().max_iterations - minimum.iterations);
  Eigen::VectorXd x = residuals.Scaled(start);
  const Eigen::LevenbergMarquardtSpace::Status status = search.minimize(x);
  minimum.iterations += static_cast<int32_t>(search.nfev());
  minimum.converged = status != Eigen::LevenbergMarquardtSpace::TooManyFunctionEvaluation;
  const std::vector<double> end = residuals.Unknowns(x);
  const double objective = ObjectiveAt(end, model);
  Step step = {.has_turned_back = residuals.has_turned_back()};
  if (!(objective <= before)) return step;
  minimum.at = end;
  minimum.objective = objective;
  const Problem& problem = model.problem();
  const bool is_at_bound = std::any_of(free.begin(), free.end(), [&problem, &end](size_t k) {
    return end[k] == problem.low[k] || end[k] == problem.high[k];
  });
  step.is_at_bound = is_at_bound && before - objective > tolerance * before;
  return step;
}

// True if the minimum lies at the edge of where numbers have a prediction, beyond which unknown k would move.
bool IsAtEdge(size_t k, Model& model, const Minimum& minimum) {
  constexpr double kBeside = 1e-6;
  const Problem& problem = model.problem();
  for (const double side : {-kBeside, kBeside}) {
    std::vector<double> at = minimum.at;
    at[k] += side * std::max(std::fabs(at[k]), 1e-3 * problem.scale[k]);
    const bool is_within = at[k] >= problem.low[k] && at[k] <= problem.high[k];
    if (is_within && !std::isfinite(ObjectiveAt(at, model))) return true;
  }
  return false;
}

// Searches from a minimum at edges, with each unknown held that would move beyond one. Returns true if the minimum is
// better by more than the tolerance.
bool GoAlongEdges(const std::vector<size_t>& free, double tolerance, Model& model, Minimum& minimum) {
  const double before = minimum.objective;
  for (size_t i = 0; i < free.size() && free.size() > 1; ++i) {
    if (minimum.iterations >= model.problem().max_iterations || !IsAtEdge(free[i], model, minimum)) continue;
    std::vector<size_t> others = free;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    Search(others, tolerance, model, minimum);
  }
  return before - minimum.objective > tolerance * before;
}

}  // namespace

Loss LossOf(const Problem& problem, double squared_residual) {
  const double square = problem.loss_scale * problem.loss_scale;
  const double part = squared_residual / square;
  switch (problem.loss) {
    case FitLoss::kHuber:
      if (part <= 1.0) break;
      return {.loss = square * (2.0 * std::sqrt(part) - 1.0), .weight = 1.0 / std::sqrt(part), .curvature = 0.0};
    case FitLoss::kCauchy: {
      const double weight = 1.0 / (1.0 + part);
      return {.loss = square * LogOfOnePlus(part), .weight = weight, .curvature = weight * (2.0 * weight - 1.0)};
    }
    case FitLoss::kUnspecified:
    case FitLoss::kSquares:
      break;
  }
  return {.loss = squared_residual, .weight = 1.0};
}

double ObjectiveAt(const std::vector<double>& at, Model& model) {
  std::vector<double> residuals;
  if (!model.Residuals(at, residuals)) return std::numeric_limits<double>::infinity();
  return ObjectiveOf(model.problem(), residuals);
}

std::vector<double> ObjectivesAt(const std::vector<std::vector<double>>& points, Model& model) {
  Table residuals;
  if (!model.ResidualsAll(points, residuals)) {
    return std::vector<double>(points.size(), std::numeric_limits<double>::infinity());
  }
  std::vector<double> objectives;
  for (const std::vector<double>& of_point : residuals) objectives.push_back(ObjectiveOf(model.problem(), of_point));
  return objectives;
}

// Eigen's search knows no bounds: an unknown that it moves beyond one stays at the bound, and the others go on. A
// further search from there sees whether the unknown should come back. Nor does it go along the edge that a rule draws,
// such as mu <= mu_static. Searches that hold an unknown there do, as far as the edge does not depend on the others.
Minimum Minimize(const std::vector<double>& start, const std::vector<bool>& is_free, double tolerance, Model& model) {
  Minimum minimum = {.at = start, .objective = ObjectiveAt(start, model), .converged = true};
  std::vector<size_t> free;
  for (size_t k = 0; k < start.size(); ++k) {
    if (is_free[k]) free.push_back(k);
  }
  if (free.empty() || !std::isfinite(minimum.objective)) return minimum;
  const auto may_go_on = [&] { return !model.is_stopped() && minimum.iterations < model.problem().max_iterations; };
  bool goes_on = true;
  while (goes_on && may_go_on()) {
    const Step step = Search(free, tolerance, model, minimum);
    goes_on = step.is_at_bound || (step.has_turned_back && GoAlongEdges(free, tolerance, model, minimum));
  }
  return minimum;
}

void Approach(const std::vector<double>& start, Model& model, Minimum& found) {
  const Problem& problem = model.problem();
  const double least = found.objective;
  const auto move = [&](size_t k, double value) {
    std::vector<double> at = found.at;
    at[k] = value;
    if (value == found.at[k] || value < problem.low[k] || value > problem.high[k]) return false;
    const double objective = ObjectiveAt(at, model);
    if (!(objective - least <= kAsGood)) return false;
    found.at = std::move(at);
    found.objective = objective;
    return true;
  };
  for (size_t k = 0; k < start.size() && std::isfinite(least); ++k) {
    if (problem.is_angle[k]) {
      move(k, start[k] + std::remainder(found.at[k] - start[k], 2.0 * std::numbers::pi));
    }
    // A number that is still in the range of the starts is not moved.
    if (!(std::fabs(found.at[k] - start[k]) > 4.0 * problem.scale[k]) || move(k, start[k])) continue;
    constexpr int kMostHalves = 1100;  // So many halves leave nothing of the largest double.
    for (int i = 0; i < kMostHalves && move(k, start[k] + 0.5 * (found.at[k] - start[k])); ++i) continue;
  }
}

}  // namespace ricochet::fit
