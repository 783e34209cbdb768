#include "core/fit/model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/answer/exact_derivatives.h"

namespace ricochet::fit {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
// The cube root of the rounding of a double: the step for which central differences are most exact.
constexpr double kStep = 6e-6;

double MeanOfSides(double below, double above) {
  if (std::isnan(below)) return std::isnan(above) ? 0.0 : above;
  return std::isnan(above) ? below : 0.5 * (below + above);
}

// The slope that a search can use where the sides differ.
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

// Solves the rows of all points together, so that they share the lanes and the threads.
bool Model::SolveAt(const std::vector<std::vector<double>>& points, Solved& solved) {
  if (is_stopped_) return false;
  const size_t rows = problem_.rows;
  const size_t count = rows * points.size();
  std::vector<std::vector<double>> fields(problem_.batch.fields.size(), std::vector<double>(count));
  for (size_t p = 0; p < points.size(); ++p) {
    const auto place = static_cast<std::ptrdiff_t>(p * rows);
    for (size_t k = 0; k < fields.size(); ++k) {
      const bool is_unknown = k < problem_.unknowns();
      if (is_unknown) std::fill_n(fields[k].begin() + place, rows, points[p][k]);
      if (!is_unknown) std::copy_n(problem_.inputs[k - problem_.unknowns()].begin(), rows, fields[k].begin() + place);
    }
  }
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

bool Model::SolveHere(absl::Span<const double> unknowns) {
  if (unknowns == at_) return !is_stopped_;
  at_.assign(unknowns.begin(), unknowns.end());
  return SolveAt({at_}, here_);
}

bool Model::Predict(absl::Span<const double> unknowns, std::vector<double>& predicted) {
  if (!SolveHere(unknowns)) return false;
  predicted = NumbersOf(here_, 0);
  return std::all_of(predicted.begin(), predicted.end(), [](double value) { return std::isfinite(value); });
}

bool Model::PredictAll(const std::vector<std::vector<double>>& points, std::vector<std::vector<double>>& predicted) {
  Solved solved;
  if (!SolveAt(points, solved)) return false;
  predicted.clear();
  for (size_t point = 0; point < points.size(); ++point) predicted.push_back(NumbersOf(solved, point));
  return true;
}

std::vector<size_t> Model::Inadmissible(const std::vector<double>& unknowns) {
  Solved solved = {.statuses = std::vector<RowStatus>(problem_.rows)};
  std::vector<size_t> rows;
  if (!SolveAt({unknowns}, solved)) return rows;
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

std::optional<BadRow> Model::Bad(const std::vector<double>& predicted) const {
  for (size_t i = 0; i < predicted.size(); ++i) {
    if (std::isfinite(predicted[i])) continue;
    const auto row = static_cast<int64_t>(problem_.numbers[i].row);
    for (const BadRow& bad : here_.bad_rows) {
      if (bad.row == row) return bad;
    }
    return BadRow{.row = row, .field = problem_.batch.columns[problem_.numbers[i].column], .description = ""};
  }
  return std::nullopt;
}

bool Model::Differentiate(absl::Span<const double> unknowns, const std::vector<bool>& is_free,
                          std::vector<double>& derivatives) {
  if (problem_.why_differences.empty()) return Exact(unknowns, is_free, derivatives);
  std::vector<double> above;
  if (!Sides(unknowns, is_free, derivatives, above)) return false;
  for (size_t i = 0; i < above.size(); ++i) derivatives[i] = MeanOfSides(derivatives[i], above[i]);
  return true;
}

bool Model::Exact(absl::Span<const double> unknowns, const std::vector<bool>& is_free,
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

bool Model::Sides(absl::Span<const double> unknowns, const std::vector<bool>& is_free, std::vector<double>& below,
                  std::vector<double>& above) {
  if (!SolveHere(unknowns)) return false;
  // Each side of a free unknown is a point.
  std::vector<std::vector<double>> points;
  for (size_t k = 0; k < unknowns.size(); ++k) {
    if (!is_free[k]) continue;
    const double step = kStep * std::max(std::fabs(unknowns[k]), 1e-3 * problem_.scale[k]);
    for (const double side : {-step, step}) {
      points.push_back(at_);
      const double value = unknowns[k] + side;
      points.back()[k] = value < problem_.low[k] || value > problem_.high[k] ? kNone : value;
    }
  }
  Solved beside;
  if (!SolveAt(points, beside)) return false;
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

const Scene& Model::SceneOf(size_t row, absl::Span<const double> unknowns) {
  for (size_t k = 0; k < problem_.batch.fields.size(); ++k) {
    const bool is_unknown = k < problem_.unknowns();
    driven_.Set(k, is_unknown ? unknowns[k] : problem_.inputs[k - problem_.unknowns()][row]);
  }
  return driven_.scene();
}

}  // namespace ricochet::fit
