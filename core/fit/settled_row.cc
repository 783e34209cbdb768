#include "core/fit/settled_row.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "core/fit/differences.h"

namespace ricochet::fit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
// Inputs are settled if a step changes none of them by more than this part of its sigma.
constexpr double kSettled = 1e-7;
// A row on a corner of the prediction ends after this many steps, each of which may be half the one before.
constexpr int kMostSteps = 40;

// The search of one row for the inputs that fit best, at one value of the unknowns.
class Settling {
 public:
  Settling(const Problem& problem, size_t row, const std::vector<double>& unknowns)
      : problem_(problem), unknowns_(unknowns), first_(problem.first_number[row]) {
    const size_t count = problem.first_number[row + 1] - first_;
    for (size_t i = 0; i < problem.inputs.size(); ++i) {
      stated_.push_back(problem.inputs[i][row]);
      const double sigma = problem.input_sigmas[i].empty() ? 0.0 : problem.input_sigmas[i][row];
      if (sigma > 0.0) uncertain_.push_back({i, sigma});
    }
    inputs_ = stated_;
    best_ = {.inputs = stated_, .residuals = VectorXd::Constant(static_cast<Index>(count), kNone), .root = {}};
    is_done_ = count == 0;
  }

  bool is_done() const { return is_done_; }
  size_t places() const { return 1 + 2 * uncertain_.size(); }
  SettledRow settled() && { return std::move(best_); }

  // Adds the fields of the places where the next step needs a prediction.
  void AppendPlaces(Table& fields) const {
    AppendPlace(inputs_, fields);
    for (size_t j = 0; j < uncertain_.size(); ++j) {
      for (const double side : {-1.0, 1.0}) {
        std::vector<double> beside = inputs_;
        beside[uncertain_[j].input] += side * StepOf(j);
        AppendPlace(beside, fields);
      }
    }
  }

  // Takes the predictions, which stand from row `at` on.
  void Take(const Table& columns, size_t at) {
    ++steps_;
    const VectorXd predicted = PredictedAt(columns, at);
    const double attained = predicted.allFinite() ? AttainedWith(predicted) : kNone;
    if (!(attained < attained_)) {
      // Without any prediction, or beyond a corner: half of the way.
      is_done_ = !std::isfinite(attained_) || !Step(0.5);
      return;
    }
    attained_ = attained;
    const MatrixXd slopes = SlopesAt(columns, at, predicted);
    SetBest(predicted, slopes);
    is_done_ = !Step(1.0);
  }

 private:
  struct Uncertain {
    size_t input;
    double sigma;
  };

  void AppendPlace(const std::vector<double>& inputs, Table& fields) const {
    for (size_t k = 0; k < unknowns_.size(); ++k) fields[k].push_back(unknowns_[k]);
    for (size_t i = 0; i < inputs.size(); ++i) fields[unknowns_.size() + i].push_back(inputs[i]);
  }

  double StepOf(size_t j) const {
    return kDifferenceStep * std::max(std::fabs(inputs_[uncertain_[j].input]), uncertain_[j].sigma);
  }

  VectorXd PredictedAt(const Table& columns, size_t at) const {
    VectorXd predicted(best_.residuals.size());
    for (Index i = 0; i < predicted.size(); ++i) predicted[i] = columns[NumberAt(i).column][at];
    return predicted;
  }

  const Number& NumberAt(Index i) const { return problem_.numbers[first_ + static_cast<size_t>(i)]; }

  // What the stated input exceeds the present one by.
  double Shift(size_t j) const { return stated_[uncertain_[j].input] - inputs_[uncertain_[j].input]; }

  double AttainedWith(const VectorXd& predicted) const {
    double sum = 0.0;
    const auto add = [&sum](double residual) { sum += residual * residual; };
    for (Index i = 0; i < predicted.size(); ++i) add(NumberAt(i).Residual(predicted[i]));
    for (size_t j = 0; j < uncertain_.size(); ++j) add(Shift(j) / uncertain_[j].sigma);
    return sum;
  }

  // J, a column for each input with an error. Beyond a rule of the scene the other side counts.
  MatrixXd SlopesAt(const Table& columns, size_t at, const VectorXd& predicted) const {
    MatrixXd slopes(predicted.size(), static_cast<Index>(uncertain_.size()));
    for (size_t j = 0; j < uncertain_.size(); ++j) {
      const VectorXd below = (predicted - PredictedAt(columns, at + 1 + 2 * j)) / StepOf(j);
      const VectorXd above = (PredictedAt(columns, at + 2 + 2 * j) - predicted) / StepOf(j);
      for (Index i = 0; i < predicted.size(); ++i) {
        slopes(i, static_cast<Index>(j)) = MeanOfSides(below[i], above[i]);
      }
    }
    return slopes;
  }

  // The present inputs are the best ones so far. Sets where the search goes from there, too.
  void SetBest(const VectorXd& predicted, const MatrixXd& slopes) {
    const auto count = static_cast<Index>(uncertain_.size());
    VectorXd difference(predicted.size());
    for (Index i = 0; i < predicted.size(); ++i) difference[i] = NumberAt(i).value - predicted[i];
    MatrixXd in_sigmas = slopes;  // J diag(s_z)
    for (Index j = 0; j < count; ++j) {
      difference -= slopes.col(j) * Shift(static_cast<size_t>(j));
      in_sigmas.col(j) *= uncertain_[static_cast<size_t>(j)].sigma;
    }
    const MatrixXd root = RootOf(in_sigmas);
    const auto lower = root.triangularView<Eigen::Lower>();
    best_ = {.inputs = inputs_, .residuals = lower.solve(difference), .root = root};
    const VectorXd shift = in_sigmas.transpose() * lower.transpose().solve(best_.residuals);
    // On a corner the linear prediction promises less than the inputs attain.
    const double promised = best_.residuals.squaredNorm();
    if (attained_ > (1.0 + kSettled) * promised && promised > 0.0) best_.residuals *= std::sqrt(attained_ / promised);
    target_ = inputs_;
    for (Index j = 0; j < count; ++j) {
      const auto& [input, sigma] = uncertain_[static_cast<size_t>(j)];
      target_[input] = stated_[input] + sigma * shift[j];
    }
  }

  // Returns L. It is the triangular factor of the rows of diag(s_y) and J diag(s_z) side by side, whose squares would
  // hide a small s_y beside what the inputs do.
  MatrixXd RootOf(const MatrixXd& in_sigmas) const {
    const Index count = in_sigmas.rows();
    MatrixXd stacked = MatrixXd::Zero(count + in_sigmas.cols(), count);
    for (Index i = 0; i < count; ++i) stacked(i, i) = NumberAt(i).sigma;
    stacked.bottomRows(in_sigmas.cols()) = in_sigmas.transpose();
    const Eigen::HouseholderQR<MatrixXd> factors(stacked);
    return factors.matrixQR().topRows(count).triangularView<Eigen::Upper>().toDenseMatrix().transpose();
  }

  // Goes `part` of the way from the best inputs to the present target, which becomes the target. Returns false if that
  // is no way at all.
  bool Step(double part) {
    bool is_settled = true;
    for (const auto& [input, sigma] : uncertain_) {
      target_[input] = best_.inputs[input] + part * (target_[input] - best_.inputs[input]);
      is_settled = is_settled && !(std::fabs(target_[input] - best_.inputs[input]) > kSettled * sigma);
    }
    inputs_ = target_;
    return !is_settled && steps_ < kMostSteps;
  }

  const Problem& problem_;
  const std::vector<double>& unknowns_;
  size_t first_;
  std::vector<Uncertain> uncertain_;
  std::vector<double> stated_, inputs_, target_;
  SettledRow best_;
  double attained_ = std::numeric_limits<double>::infinity();
  int steps_ = 0;
  bool is_done_ = false;
};

}  // namespace

bool SettleRows(const Problem& problem, const Table& points, SolveTable solve, std::vector<SettledRow>& rows) {
  std::vector<Settling> all;
  for (const std::vector<double>& unknowns : points) {
    for (size_t row = 0; row < problem.rows; ++row) all.emplace_back(problem, row, unknowns);
  }
  std::vector<Settling*> waiting;
  for (Settling& one : all) {
    if (!one.is_done()) waiting.push_back(&one);
  }
  while (!waiting.empty()) {
    Table fields(problem.batch.fields.size()), columns;
    for (const Settling* const one : waiting) one->AppendPlaces(fields);
    if (!solve(fields, columns)) return false;
    size_t at = 0;
    for (Settling* const one : waiting) {
      one->Take(columns, at);
      at += one->places();
    }
    std::erase_if(waiting, [](const Settling* one) { return one->is_done(); });
  }
  rows.clear();
  for (Settling& one : all) rows.push_back(std::move(one).settled());
  return true;
}

}  // namespace ricochet::fit
