#include "core/fit/settled_row.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <deque>
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
// Further searches look at these distances on both sides of each stated input, in sigmas.
constexpr std::array<double, 3> kProbes = {0.75, 1.5, 3.0};
// A further search starts from the nearest probe at which a number differs from the straight lines of the first search
// by more than this part of its sigma.
constexpr double kSurprise = 0.1;

// The inputs that a row states, and the numbers that it measured.
class Row {
 public:
  struct Uncertain {
    size_t input;
    double sigma;
    double size;       // That of the input in any row.
    double low, high;  // Between these the input keeps its rule.
    Index place;       // Among the uncertain inputs of the problem.

    double Within(double value) const { return std::clamp(value, low, high); }
    // True if the input lies at an end, beyond which the target is.
    bool IsHeld(double value, double target) const {
      return (value <= low && target < low) || (value >= high && target > high);
    }
  };

  // `sizes` are those of the problem's inputs.
  Row(const Problem& problem, size_t row, const std::vector<double>& sizes)
      : problem_(problem), first_(problem.first_number[row]), count_(problem.first_number[row + 1] - first_) {
    for (size_t i = 0; i < problem.inputs.size(); ++i) {
      stated_.push_back(problem.inputs[i][row]);
      const double sigma = problem.input_sigmas[i].empty() ? 0.0 : problem.input_sigmas[i][row];
      const auto [low, high] = problem.input_ranges[i];
      if (sigma > 0.0) uncertain_.push_back({i, sigma, sizes[i] > 0.0 ? sizes[i] : sigma, low, high, places_});
      if (!problem.input_sigmas[i].empty()) ++places_;
    }
  }

  const std::vector<double>& stated() const { return stated_; }
  const std::vector<Uncertain>& uncertain() const { return uncertain_; }
  Index count() const { return static_cast<Index>(count_); }
  Index places() const { return places_; }  // How many uncertain inputs the problem has.
  bool has_robust_loss() const { return problem_.loss != FitLoss::kSquares; }
  const Number& NumberAt(Index i) const { return problem_.numbers[first_ + static_cast<size_t>(i)]; }

  VectorXd PredictedIn(const Table& columns, size_t at) const {
    VectorXd predicted(count());
    for (Index i = 0; i < count(); ++i) predicted[i] = columns[NumberAt(i).column][at];
    return predicted;
  }

  // Returns the stated inputs with errors minus the given ones.
  VectorXd ShiftFrom(const std::vector<double>& inputs) const {
    VectorXd shift(static_cast<Index>(uncertain_.size()));
    for (Index j = 0; j < shift.size(); ++j) {
      const size_t input = uncertain_[static_cast<size_t>(j)].input;
      shift[j] = stated_[input] - inputs[input];
    }
    return shift;
  }

  // Returns NaN if a number has no prediction.
  double Objective(const VectorXd& predicted, const std::vector<double>& inputs) const {
    if (!predicted.allFinite()) return kNone;
    double sum = 0.0;
    const auto add = [&sum](double residual) { sum += residual * residual; };
    for (Index i = 0; i < count(); ++i) add(NumberAt(i).Residual(predicted[i]));
    const VectorXd shift = ShiftFrom(inputs);
    for (Index j = 0; j < shift.size(); ++j) add(shift[j] / uncertain_[static_cast<size_t>(j)].sigma);
    return sum;
  }

 private:
  const Problem& problem_;
  size_t first_, count_;
  std::vector<double> stated_;
  std::vector<Uncertain> uncertain_;
  Index places_ = 0;
};

void AppendPlace(const std::vector<double>& unknowns, const std::vector<double>& inputs, Table& fields) {
  for (size_t k = 0; k < unknowns.size(); ++k) fields[k].push_back(unknowns[k]);
  for (size_t i = 0; i < inputs.size(); ++i) fields[unknowns.size() + i].push_back(inputs[i]);
}

// Appends a place at which the input `moved` has another value.
void AppendPlace(const std::vector<double>& unknowns, const std::vector<double>& inputs, size_t moved, double value,
                 Table& fields) {
  AppendPlace(unknowns, inputs, fields);
  fields[unknowns.size() + moved].back() = value;
}

// A search of a row for the inputs that fit best, at one value of the unknowns.
class Search {
 public:
  Search(const Row& row, const std::vector<double>& unknowns, std::vector<double> start)
      : row_(row), unknowns_(unknowns), inputs_(std::move(start)), is_done_(row.count() == 0) {
    const VectorXd none = VectorXd::Constant(row.count(), kNone);
    best_ = {.inputs = inputs_,
             .predicted = none,
             .sigmas = none,
             .residuals = none,
             .whitening = {},
             .held = VectorXd::Zero(row.places()),
             .held_inputs = 0};
  }

  const Row& row() const { return row_; }
  const std::vector<double>& unknowns() const { return unknowns_; }
  const SettledRow& best() const { return best_; }
  double attained() const { return attained_; }  // Infinite if nothing was found.

  bool is_done() const { return is_done_; }
  size_t places() const { return 1 + 2 * row_.uncertain().size(); }

  // Adds the fields of the places where the next step needs a prediction.
  void AppendPlaces(Table& fields) const {
    AppendPlace(unknowns_, inputs_, fields);
    for (const Row::Uncertain& uncertain : row_.uncertain()) {
      const double step = StepOf(uncertain);
      for (const double distance : {-step, step})
        AppendPlace(unknowns_, inputs_, uncertain.input, inputs_[uncertain.input] + distance, fields);
    }
  }

  // Takes over the predictions of this step, which begin at row `at` of the columns.
  void Take(const Table& columns, size_t at) {
    ++steps_;
    const VectorXd predicted = row_.PredictedIn(columns, at);
    const double attained = row_.Objective(predicted, inputs_);
    if (attained < attained_) {
      attained_ = attained;
      slopes_ = SlopesIn(columns, at, predicted);
      SetBest(predicted);
      part_ = std::min(1.0, 2.0 * part_);
    } else {
      part_ *= 0.5;  // The way leads beyond a corner.
    }
    is_done_ = !std::isfinite(attained_) || steps_ == kMostSteps || !Moves(part_);
    if (!is_done_) return Step();
    // At a corner of f the straight lines promise a smaller objective than the inputs attain.
    const double promised = best_.residuals.squaredNorm();
    const double own = attained_ - best_.held.squaredNorm();
    const bool is_on_corner = std::isfinite(attained_) && Moves(1.0);
    if (is_on_corner && promised > 0.0) best_.residuals *= std::sqrt(std::max(own, 0.0) / promised);
  }

  // True if the stated inputs have a prediction, with the j-th uncertain one off by `distance`, that is not on the
  // straight lines at the best ones.
  bool IsSurprising(const VectorXd& predicted, size_t j, double distance) const {
    if (!predicted.allFinite() || !std::isfinite(attained_)) return predicted.allFinite();
    for (Index i = 0; i < predicted.size(); ++i) {
      const double on_line = at_stated_[i] + distance * slopes_(i, static_cast<Index>(j));
      if (!(std::fabs(predicted[i] - on_line) <= kSurprise * row_.NumberAt(i).sigma)) return true;
    }
    return false;
  }

 private:
  double StepOf(const Row::Uncertain& uncertain) const {
    constexpr double kLeastPart = 0.1;
    return kDifferenceStep * std::max(std::fabs(inputs_[uncertain.input]), kLeastPart * uncertain.size);
  }

  // Returns J with a column for each input with an error. If one side breaks a rule of the scene, the other one counts.
  MatrixXd SlopesIn(const Table& columns, size_t at, const VectorXd& predicted) const {
    MatrixXd slopes(predicted.size(), static_cast<Index>(row_.uncertain().size()));
    for (size_t j = 0; j < row_.uncertain().size(); ++j) {
      const double step = StepOf(row_.uncertain()[j]);
      const VectorXd below = (predicted - row_.PredictedIn(columns, at + 1 + 2 * j)) / step;
      const VectorXd above = (row_.PredictedIn(columns, at + 2 + 2 * j) - predicted) / step;
      for (Index i = 0; i < predicted.size(); ++i) {
        slopes(i, static_cast<Index>(j)) = MeanOfSides(below[i], above[i]);
      }
    }
    return slopes;
  }

  // Keeps the present inputs as the best ones so far and sets where the search goes next. Inputs that would leave their
  // range are held, one after the other.
  void SetBest(const VectorXd& predicted) {
    best_.inputs = inputs_;
    best_.held.setZero();
    best_.held_inputs = 0;
    const std::vector<Row::Uncertain>& uncertain = row_.uncertain();
    const VectorXd shift = row_.ShiftFrom(inputs_);
    at_stated_ = predicted + slopes_ * shift;
    std::vector<bool> is_held(uncertain.size(), false);
    const auto would_leave = [this](const Row::Uncertain& one) {
      return one.IsHeld(inputs_[one.input], target_[one.input]);
    };
    while (true) {
      SetTarget(predicted, is_held);
      const auto next = std::find_if(uncertain.begin(), uncertain.end(), would_leave);
      if (next == uncertain.end()) return;
      const auto j = next - uncertain.begin();
      is_held[static_cast<size_t>(j)] = true;
      ++best_.held_inputs;
      best_.held[next->place] = shift[j] / next->sigma;
    }
  }

  // Sets the objective that the straight lines at the present inputs promise, and the target. Held inputs do not move.
  void SetTarget(const VectorXd& predicted, const std::vector<bool>& is_held) {
    MatrixXd free_slopes = slopes_;
    for (Index j = 0; j < free_slopes.cols(); ++j) {
      if (is_held[static_cast<size_t>(j)]) free_slopes.col(j).setZero();
    }
    MatrixXd in_sigmas = free_slopes;  // J diag(s_z)
    for (Index j = 0; j < in_sigmas.cols(); ++j) in_sigmas.col(j) *= row_.uncertain()[static_cast<size_t>(j)].sigma;
    MatrixXd stacked = MatrixXd::Zero(row_.count() + in_sigmas.cols(), row_.count());
    VectorXd measured(row_.count());
    for (Index i = 0; i < row_.count(); ++i) {
      measured[i] = row_.NumberAt(i).value;
      stacked(i, i) = row_.NumberAt(i).sigma;
    }
    stacked.bottomRows(in_sigmas.cols()) = in_sigmas.transpose();
    best_.predicted = predicted + free_slopes * row_.ShiftFrom(inputs_);
    best_.sigmas = stacked.colwise().norm().transpose();
    best_.whitening = WhiteningOf(stacked);
    best_.residuals = best_.whitening * (measured - best_.predicted);
    const VectorXd shift = in_sigmas.transpose() * (best_.whitening.transpose() * best_.residuals);
    target_ = inputs_;
    for (Index j = 0; j < shift.size(); ++j) {
      const Row::Uncertain& uncertain = row_.uncertain()[static_cast<size_t>(j)];
      if (is_held[static_cast<size_t>(j)]) continue;
      target_[uncertain.input] = row_.stated()[uncertain.input] + uncertain.sigma * shift[j];
    }
  }

  // Returns R for C = A^T A. C itself would hide a small s_y beside what the inputs do.
  MatrixXd WhiteningOf(const MatrixXd& a) const {
    if (row_.has_robust_loss()) {
      const Eigen::JacobiSVD<MatrixXd> parts(a, Eigen::ComputeThinU | Eigen::ComputeThinV);
      return parts.matrixV() * parts.singularValues().cwiseInverse().asDiagonal() * parts.matrixV().transpose();
    }
    const MatrixXd root = Eigen::HouseholderQR<MatrixXd>(a).matrixQR().topRows(a.cols()).transpose();
    return root.triangularView<Eigen::Lower>().solve(MatrixXd::Identity(a.cols(), a.cols()));
  }

  double WayOf(const Row::Uncertain& uncertain) const {
    return uncertain.Within(target_[uncertain.input]) - best_.inputs[uncertain.input];
  }

  // True if this part of the way from the best inputs to the target is more than nothing.
  bool Moves(double part) const {
    return std::any_of(row_.uncertain().begin(), row_.uncertain().end(), [&](const Row::Uncertain& uncertain) {
      return std::fabs(part * WayOf(uncertain)) > kSettled * uncertain.sigma;
    });
  }

  void Step() {
    inputs_ = best_.inputs;
    for (const Row::Uncertain& uncertain : row_.uncertain()) {
      // A full step goes to the target itself, because a sum could round beside it.
      inputs_[uncertain.input] = uncertain.Within(part_ == 1.0 ? target_[uncertain.input]
                                                               : inputs_[uncertain.input] + part_ * WayOf(uncertain));
    }
  }

  const Row& row_;
  const std::vector<double>& unknowns_;
  std::vector<double> inputs_, target_;
  MatrixXd slopes_;     // J at the best inputs.
  VectorXd at_stated_;  // The prediction for the stated inputs by these straight lines.
  SettledRow best_;
  double attained_ = std::numeric_limits<double>::infinity();
  double part_ = 1.0;  // The next step goes this part of the way to the target.
  int steps_ = 0;
  bool is_done_;
};

// Runs the searches until each is done. Returns false once `solve` does.
bool Run(const Problem& problem, std::deque<Search>& searches, SolveTable solve) {
  std::vector<Search*> waiting;
  for (Search& one : searches) waiting.push_back(&one);
  while (true) {
    std::erase_if(waiting, [](const Search* one) { return one->is_done(); });
    if (waiting.empty()) return true;
    Table fields(problem.batch.fields.size()), columns;
    for (const Search* const one : waiting) one->AppendPlaces(fields);
    if (!solve(fields, columns)) return false;
    size_t at = 0;
    for (Search* const one : waiting) {
      one->Take(columns, at);
      at += one->places();
    }
  }
}

// Calls `visit` with each place where a further search of a row may start: the j-th uncertain input has another value
// within its range. The places on one side of one input come from near to far.
template <typename Visit>
void ForEachProbe(const Row& row, Visit visit) {
  for (size_t j = 0; j < row.uncertain().size() && row.count() > 0; ++j) {
    const Row::Uncertain& uncertain = row.uncertain()[j];
    const double unit = std::min(uncertain.sigma, uncertain.size);
    for (const double side : {-1.0, 1.0}) {
      for (const double distance : kProbes) {
        const double value = uncertain.Within(row.stated()[uncertain.input] + side * distance * unit);
        visit(j, value, distance == kProbes.front());
      }
    }
  }
}

// Adds to `further` a search from the nearest probe on each side at which one of `searches` meets a surprise
// (kSurprise), and to `of` which one that is.
bool LookFurther(const Problem& problem, const std::deque<Search>& searches, SolveTable solve,
                 std::deque<Search>& further, std::vector<size_t>& of) {
  Table fields(problem.batch.fields.size()), columns;
  for (const Search& one : searches) {
    ForEachProbe(one.row(), [&](size_t j, double value, bool /*is_nearest*/) {
      AppendPlace(one.unknowns(), one.row().stated(), one.row().uncertain()[j].input, value, fields);
    });
  }
  if (fields.front().empty()) return true;
  if (!solve(fields, columns)) return false;
  size_t at = 0;
  for (size_t i = 0; i < searches.size(); ++i) {
    const Search& one = searches[i];
    bool has_started = false;  // On this side of the input.
    ForEachProbe(one.row(), [&](size_t j, double value, bool is_nearest) {
      if (is_nearest) has_started = false;
      const VectorXd predicted = one.row().PredictedIn(columns, at++);
      const size_t input = one.row().uncertain()[j].input;
      if (has_started || !one.IsSurprising(predicted, j, value - one.row().stated()[input])) return;
      has_started = true;
      std::vector<double> start = one.row().stated();
      start[input] = value;
      further.emplace_back(one.row(), one.unknowns(), std::move(start));
      of.push_back(i);
    });
  }
  return true;
}

// Settles some searches from the stated inputs.
bool SettleBlock(const Problem& problem, std::deque<Search>& searches, SolveTable solve, TakeRow take) {
  std::deque<Search> further;
  std::vector<size_t> of;
  if (!Run(problem, searches, solve) || !LookFurther(problem, searches, solve, further, of)) return false;
  if (!Run(problem, further, solve)) return false;
  std::vector<const Search*> best;
  for (const Search& one : searches) best.push_back(&one);
  for (size_t i = 0; i < further.size(); ++i) {
    if (further[i].attained() < best[of[i]]->attained()) best[of[i]] = &further[i];
  }
  for (const Search* const one : best) take(one->best());
  return true;
}

}  // namespace

bool SettleRows(const Problem& problem, const Table& points, SolveTable solve, TakeRow take) {
  std::vector<double> sizes;
  for (const std::vector<double>& column : problem.inputs) {
    double size = 0.0;
    for (const double value : column) size = std::max(size, std::fabs(value));
    sizes.push_back(size);
  }
  std::deque<Row> of_problem;
  for (size_t row = 0; row < problem.rows; ++row) of_problem.emplace_back(problem, row, sizes);
  // A block takes little memory, and the caller can stop after it.
  constexpr size_t kBlock = 1024;
  std::deque<Search> searches;
  for (size_t p = 0; p < points.size(); ++p) {
    for (size_t row = 0; row < problem.rows; ++row) {
      searches.emplace_back(of_problem[row], points[p], of_problem[row].stated());
      const bool is_last = p + 1 == points.size() && row + 1 == problem.rows;
      if (searches.size() < kBlock && !is_last) continue;
      if (!SettleBlock(problem, searches, solve, take)) return false;
      searches.clear();
    }
  }
  return true;
}

}  // namespace ricochet::fit
