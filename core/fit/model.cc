#include "core/fit/model.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "core/answer/exact_derivatives.h"
#include "core/fit/differences.h"

namespace ricochet::fit {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// Returns the slope that a search uses, which is the mean of both sides where they differ.
double SlopeOf(const Derivative& derivative) {
  if (derivative.value.has_value()) return *derivative.value;
  return MeanOfSides(derivative.from_below.value_or(kNone), derivative.from_above.value_or(kNone));
}

}  // namespace

Model::Model(const Problem& problem, SolveRows solve_rows, absl::FunctionRef<bool()> stopped)
    : problem_(problem),
      solve_rows_(std::move(solve_rows)),
      stopped_(stopped),
      driven_(problem.batch.scene, problem.batch.fields) {}

bool Model::SolveAt(const Table& points, const Table& inputs, Solved& solved) {
  const size_t rows = problem_.rows;
  Table fields(problem_.batch.fields.size(), std::vector<double>(rows * points.size()));
  for (size_t p = 0; p < points.size(); ++p) {
    const auto place = static_cast<std::ptrdiff_t>(p * rows);
    for (size_t k = 0; k < fields.size(); ++k) {
      const bool is_unknown = k < problem_.unknowns();
      if (is_unknown) std::fill_n(fields[k].begin() + place, rows, points[p][k]);
      if (!is_unknown) std::copy_n(inputs[k - problem_.unknowns()].begin(), rows, fields[k].begin() + place);
    }
  }
  return Solve(fields, solved);
}

bool Model::Solve(const Table& fields, Solved& solved) {
  if (is_stopped_) return false;
  const size_t count = fields[0].size();
  solved.columns.assign(problem_.columns(), std::vector<double>(count));
  solved.regimes.resize(count);
  BatchRows batch = {.inputs = {fields.begin(), fields.end()},
                     .outputs = {solved.columns.begin(), solved.columns.end()},
                     .regimes = absl::MakeSpan(solved.regimes),
                     .statuses = absl::MakeSpan(solved.statuses)};
  absl::StatusOr<BatchSummary> summary = solve_rows_(batch, stopped_);
  is_stopped_ = !summary.ok();
  if (!is_stopped_) solved.bad_rows = std::move(summary->bad_rows);
  return !is_stopped_;
}

bool Model::SolveHere(const std::vector<double>& unknowns) {
  if (unknowns == at_) return !is_stopped_;
  at_ = unknowns;
  return SolveAt({at_}, InputsAt(at_), here_);
}

bool Model::Settle(const Table& points, TakeRow take) {
  const auto solve = [this](const Table& fields, Table& columns) {
    Solved solved;
    if (!Solve(fields, solved)) return false;
    columns = std::move(solved.columns);
    return true;
  };
  return SettleRows(problem_, points, solve, take);
}

bool Model::SettleHere(const std::vector<double>& unknowns) {
  if (unknowns == settled_at_) return !is_stopped_;
  settled_at_ = unknowns;
  settled_.clear();
  if (!Settle({unknowns}, [this](const SettledRow& row) { settled_.push_back(row); })) return false;
  settled_inputs_ = problem_.inputs;
  for (size_t row = 0; row < settled_.size(); ++row) {
    for (size_t i = 0; i < settled_inputs_.size(); ++i) settled_inputs_[i][row] = settled_[row].inputs[i];
  }
  return true;
}

const Table& Model::InputsAt(const std::vector<double>& unknowns) {
  return problem_.has_uncertain_inputs() && SettleHere(unknowns) ? settled_inputs_ : problem_.inputs;
}

// Replaces predicted numbers by their residuals.
static void SubtractFrom(const std::vector<Number>& numbers, std::vector<double>& predicted) {
  for (size_t i = 0; i < numbers.size(); ++i) predicted[i] = numbers[i].Residual(predicted[i]);
}

static void Append(const Eigen::VectorXd& of_row, std::vector<double>& numbers) {
  numbers.insert(numbers.end(), of_row.begin(), of_row.end());
}

bool Model::Residuals(const std::vector<double>& unknowns, std::vector<double>& residuals) {
  residuals.clear();
  if (!problem_.has_uncertain_inputs()) {
    if (!SolveHere(unknowns)) return false;
    residuals = NumbersOf(here_, 0);
    const bool exist =
        std::all_of(residuals.begin(), residuals.end(), [](double value) { return std::isfinite(value); });
    SubtractFrom(problem_.numbers, residuals);
    return exist && Resolves(unknowns);
  }
  if (!SettleHere(unknowns)) return false;
  for (const SettledRow& row : settled_) Append(row.residuals, residuals);
  for (const SettledRow& row : settled_) Append(row.held, residuals);
  const auto is_none = [](double value) { return std::isnan(value); };
  return std::none_of(residuals.begin(), residuals.end(), is_none) && Resolves(unknowns);
}

bool Model::Resolves(const std::vector<double>& unknowns) {
  // Near their scales unknowns do not cancel by as much, and the slopes are not worth their time.
  constexpr double kFar = 0x1p10;
  constexpr double kMostOfSigma = 1e-4;
  // Terms that are at most so many times as large as the measured number have not cancelled.
  constexpr double kCancels = 0x1p10;
  bool is_far = false;
  for (size_t k = 0; k < unknowns.size(); ++k) is_far |= std::fabs(unknowns[k]) > kFar * problem_.scale[k];
  std::vector<double> slopes;
  if (!is_far || !Slopes(unknowns, std::vector<bool>(unknowns.size(), true), slopes)) return true;
  for (size_t i = 0; i < slopes.size(); ++i) {
    const Number& number = problem_.numbers[i / unknowns.size()];
    const double terms = std::fabs(slopes[i] * unknowns[i % unknowns.size()]);
    if (terms * 0x1p-53 > kMostOfSigma && terms * number.sigma > kCancels * std::fabs(number.value)) return false;
  }
  return true;
}

bool Model::ResidualsAll(const Table& points, Table& residuals) {
  residuals.clear();
  if (!problem_.has_uncertain_inputs()) {
    Solved solved;
    if (!SolveAt(points, problem_.inputs, solved)) return false;
    for (size_t point = 0; point < points.size(); ++point) {
      SubtractFrom(problem_.numbers, residuals.emplace_back(NumbersOf(solved, point)));
    }
    return true;
  }
  size_t settled = 0;
  std::vector<double> held;
  return Settle(points, [&](const SettledRow& row) {
    if (settled % problem_.rows == 0) residuals.emplace_back();
    Append(row.residuals, residuals.back());
    Append(row.held, held);
    if (++settled % problem_.rows != 0) return;
    residuals.back().insert(residuals.back().end(), held.begin(), held.end());
    held.clear();
  });
}

std::vector<double> Model::Sigmas(const std::vector<double>& unknowns) {
  std::vector<double> sigmas;
  for (const Number& number : problem_.numbers) sigmas.push_back(number.sigma);
  if (!problem_.has_uncertain_inputs() || !SettleHere(unknowns)) return sigmas;
  sigmas.clear();
  for (const SettledRow& row : settled_) Append(row.sigmas, sigmas);
  return sigmas;
}

int64_t Model::HeldInputs(const std::vector<double>& unknowns) {
  int64_t held = 0;
  if (!problem_.has_uncertain_inputs() || !SettleHere(unknowns)) return held;
  for (const SettledRow& row : settled_) held += static_cast<int64_t>(row.held_inputs);
  return held;
}

bool Model::PredictRows(const std::vector<double>& unknowns, std::vector<Regime>& regimes,
                        std::vector<double>& predicted) {
  if (!SolveHere(unknowns)) return false;
  regimes = here_.regimes;
  predicted = NumbersOf(here_, 0);
  if (!problem_.has_uncertain_inputs()) return true;
  if (!SettleHere(unknowns)) return false;
  predicted.clear();
  for (const SettledRow& row : settled_) Append(row.predicted, predicted);
  return true;
}

std::vector<size_t> Model::Inadmissible(const std::vector<double>& unknowns) {
  Solved solved = {.statuses = std::vector<RowStatus>(problem_.rows)};
  std::vector<size_t> rows;
  if (!SolveAt({unknowns}, InputsAt(unknowns), solved)) return rows;
  for (size_t row = 0; row < solved.statuses.size(); ++row) {
    if (solved.statuses[row] == RowStatus::kInadmissible) rows.push_back(row);
  }
  return rows;
}

std::vector<double> Model::NumbersOf(const Solved& solved, size_t point) const {
  std::vector<double> numbers;
  for (const Number& number : problem_.numbers) {
    numbers.push_back(solved.columns[number.column][point * problem_.rows + number.row]);
  }
  return numbers;
}

std::optional<BadRow> Model::Bad(const std::vector<double>& unknowns) {
  Solved solved;
  if (!SolveAt({unknowns}, problem_.inputs, solved)) return std::nullopt;
  const std::vector<double> predicted = NumbersOf(solved, 0);
  for (size_t i = 0; i < predicted.size(); ++i) {
    if (std::isfinite(predicted[i])) continue;
    const auto row = static_cast<int64_t>(problem_.numbers[i].row);
    for (const BadRow& bad : solved.bad_rows) {
      if (bad.row == row) return bad;
    }
    return BadRow{.row = row, .field = problem_.batch.columns[problem_.numbers[i].column], .description = ""};
  }
  return std::nullopt;
}

bool Model::Slopes(const std::vector<double>& unknowns, const std::vector<bool>& is_free, std::vector<double>& slopes) {
  if (!Differentiate(unknowns, is_free, slopes)) return false;
  const size_t size = unknowns.size();
  if (!problem_.has_uncertain_inputs()) {
    for (size_t i = 0; i < slopes.size(); ++i) slopes[i] = -slopes[i] / problem_.numbers[i / size].sigma;
    return true;
  }
  for (size_t row = 0; row < settled_.size(); ++row) {
    const Eigen::MatrixXd& whitening = settled_[row].whitening;
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> of_row(
        slopes.data() + problem_.first_number[row] * size, whitening.rows(), static_cast<Eigen::Index>(size));
    of_row = -whitening * Eigen::MatrixXd(of_row);
  }
  return true;
}

bool Model::Differentiate(const std::vector<double>& unknowns, const std::vector<bool>& is_free,
                          std::vector<double>& derivatives) {
  if (problem_.why_differences.empty()) return Exact(unknowns, is_free, derivatives);
  std::vector<double> above;
  if (!Sides(unknowns, is_free, derivatives, above)) return false;
  for (size_t i = 0; i < above.size(); ++i) derivatives[i] = MeanOfSides(derivatives[i], above[i]);
  return true;
}

bool Model::Exact(const std::vector<double>& unknowns, const std::vector<bool>& is_free,
                  std::vector<double>& derivatives) {
  DerivativePaths paths = {.of = problem_.batch.columns, .by = {}};
  std::vector<size_t> places;
  for (size_t k = 0; k < unknowns.size(); ++k) {
    if (!is_free[k]) continue;
    places.push_back(k);
    paths.by.push_back(problem_.batch.fields[k]);
  }
  derivatives.assign(problem_.numbers.size() * unknowns.size(), 0.0);
  std::optional<ExactDerivatives> exact;
  std::optional<size_t> row;
  for (size_t i = 0; i < problem_.numbers.size(); ++i) {
    const Number& number = problem_.numbers[i];
    if (row != number.row) {
      std::optional<SceneContact> contact;
      const Scene& scene = SceneOf(number.row, unknowns);
      if (Stops() || !driven_.IsValid(contact)) return false;
      if (!exact.has_value()) exact.emplace(scene, paths);
      exact->Compute(scene);
      row = number.row;
    }
    for (size_t j = 0; j < places.size(); ++j) {
      derivatives[i * unknowns.size() + places[j]] = SlopeOf(exact->At(number.column, j));
    }
  }
  return true;
}

bool Model::Sides(const std::vector<double>& unknowns, const std::vector<bool>& is_free, std::vector<double>& below,
                  std::vector<double>& above) {
  if (!SolveHere(unknowns)) return false;
  // Each free unknown gives two points, one on each side.
  Table points;
  for (size_t k = 0; k < unknowns.size(); ++k) {
    if (!is_free[k]) continue;
    const double step = kDifferenceStep * std::max(std::fabs(unknowns[k]), 1e-3 * problem_.scale[k]);
    for (const double side : {-step, step}) {
      points.push_back(unknowns);
      const double value = unknowns[k] + side;
      points.back()[k] = value < problem_.low[k] || value > problem_.high[k] ? kNone : value;
    }
  }
  Solved beside;
  if (!SolveAt(points, InputsAt(unknowns), beside)) return false;
  below.assign(problem_.numbers.size() * unknowns.size(), 0.0);
  above = below;
  const std::vector<double> here = NumbersOf(here_, 0);
  size_t point = 0;
  for (size_t k = 0; k < unknowns.size(); ++k) {
    if (!is_free[k]) continue;
    for (std::vector<double>* const side : {&below, &above}) {
      const std::vector<double> there = NumbersOf(beside, point);
      for (size_t i = 0; i < here.size(); ++i) {
        (*side)[i * unknowns.size() + k] = (there[i] - here[i]) / (points[point][k] - unknowns[k]);
      }
      ++point;
    }
  }
  return true;
}

const Scene& Model::SceneOf(size_t row, const std::vector<double>& unknowns) {
  const Table& inputs = InputsAt(unknowns);
  for (size_t k = 0; k < problem_.batch.fields.size(); ++k) {
    const bool is_unknown = k < problem_.unknowns();
    driven_.Set(k, is_unknown ? unknowns[k] : inputs[k - problem_.unknowns()][row]);
  }
  return driven_.scene();
}

}  // namespace ricochet::fit
