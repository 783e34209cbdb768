#include "core/fit/information.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <unsupported/Eigen/SpecialFunctions>

#include "core/fit/search.h"
#include "core/numerics/elementary.h"

namespace ricochet::fit {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
// Derivatives by differences are right to some 1e-7 of the numbers, exact ones to rounding. A slope below this part of
// them counts as 0.
double NothingOf(const Problem& problem) { return problem.why_differences.empty() ? 1e-11 : 1e-6; }

// Returns the size of the numbers of each column, at least that of all columns of its kind: a velocity that is 0
// belongs to a contact whose other velocities tell the size.
std::vector<double> SizesOf(const Problem& problem, const LinearResiduals& residuals) {
  std::map<std::string, double> by_kind;
  const auto size_of_kind = [&](size_t column) -> double& {
    const std::string& path = problem.batch.columns[column];
    return by_kind[path.substr(0, path.find('.'))];
  };
  for (size_t i = 0; i < problem.numbers.size(); ++i) {
    const Number& number = problem.numbers[i];
    const double predicted = number.value - residuals.values[i] * residuals.sigmas[i];
    double& size = size_of_kind(number.column);
    size = std::max({size, std::fabs(number.value), std::fabs(predicted)});
  }
  std::vector<double> sizes;
  for (size_t column = 0; column < problem.batch.columns.size(); ++column) sizes.push_back(size_of_kind(column));
  return sizes;
}

// An unknown whose part of an unseen combination is smaller than this counts as seen.
constexpr double kLeastPart = 1e-3;

// The caller may stop the computation after each block of this many rows of derivatives.
constexpr Eigen::Index kBlock = 4096;

// The share of each row in the square of a column of J.
std::vector<double> SharesOf(const Problem& problem, const Eigen::VectorXd& column) {
  std::vector<double> shares(problem.rows, 0.0);
  const double square = column.squaredNorm();
  for (size_t i = 0; i < problem.numbers.size(); ++i) {
    const double slope = column[static_cast<Eigen::Index>(i)];
    shares[problem.numbers[i].row] += slope * slope / square;
  }
  return shares;
}

// A matrix of few rows with the singular values of `slopes` and their right vectors: the triangular factor of block
// after block of its rows with the factor before. A decomposition of all rows at once could not be stopped.
Eigen::MatrixXd FewRowsOf(const Eigen::MatrixXd& slopes, absl::FunctionRef<bool()> stopped) {
  Eigen::MatrixXd factor = slopes.topRows(std::min(kBlock, slopes.rows()));
  for (Eigen::Index row = factor.rows(); row < slopes.rows() && !stopped(); row += kBlock) {
    const Eigen::Index count = std::min(kBlock, slopes.rows() - row);
    Eigen::MatrixXd stacked(factor.rows() + count, slopes.cols());
    stacked << factor, slopes.middleRows(row, count);
    factor =
        Eigen::HouseholderQR<Eigen::MatrixXd>(stacked).matrixQR().topRows(slopes.cols()).triangularView<Eigen::Upper>();
  }
  return factor;
}

// Sums of psi^2 and of psi'.
struct Sums {
  double square = 0.0;
  double slope = 0.0;

  void Add(const Problem& problem, double residual, double part) {
    const Loss loss = LossOf(problem, residual * residual);
    const double psi = loss.weight * residual;
    square += part * psi * psi;
    slope += part * loss.curvature;
  }
};

// The means for normal residuals, by the trapezoidal rule over the logarithm of |r|, so that any scale of the loss is
// resolved. The scale, where psi' may jump, lies halfway between two places.
Sums NormalMeans(const Problem& problem) {
  constexpr double kRatio = 1.01;
  constexpr double kLargest = 9.0;
  constexpr double kSmallPart = 1e-9;  // Parts of the scale below this have no share in the means.
  constexpr double kDensityOfBothSigns = std::numbers::sqrt2 * std::numbers::inv_sqrtpi;
  const double step = Log(kRatio);
  const double scale = problem.loss_scale;
  const double steps = std::ceil(Log(std::max(scale, 1.0) / kSmallPart) / step);
  Sums means;
  double r = scale * Exp(-(steps + 0.5) * step);
  while (r < kLargest) {
    means.Add(problem, r, kDensityOfBothSigns * Exp(-0.5 * r * r) * r * step);
    r *= kRatio;
  }
  return means;
}

}  // namespace

Information InformationOf(const Problem& problem, const std::vector<double>& at, const LinearResiduals& residuals,
                          absl::FunctionRef<bool()> stopped) {
  const auto count = static_cast<Eigen::Index>(problem.numbers.size());
  const auto size = static_cast<Eigen::Index>(problem.unknowns());
  Eigen::MatrixXd slopes(count, size);
  // These are the lengths of the numbers of each column in sigmas, and of their slopes.
  const std::vector<double> sizes = SizesOf(problem, residuals);
  Eigen::VectorXd numbers = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(sizes.size()));
  Eigen::MatrixXd changes = Eigen::MatrixXd::Zero(numbers.size(), size);
  double chi2 = 0.0, weights = 0.0;                    // Sums.
  Eigen::VectorXd fall = Eigen::VectorXd::Zero(size);  // Half the fall of the objective by each unknown.
  for (Eigen::Index i = 0; i < count; ++i) {
    if (i % kBlock == kBlock - 1 && stopped()) return {};
    const auto number = static_cast<size_t>(i);
    const double residual = residuals.values[number];
    const auto column = static_cast<Eigen::Index>(problem.numbers[number].column);
    numbers[column] = Hypot(numbers[column], sizes[problem.numbers[number].column] / residuals.sigmas[number]);
    const double weight = LossOf(problem, residual * residual).weight;
    chi2 += residual * residual;
    weights += weight;
    for (Eigen::Index k = 0; k < size; ++k) {
      const double slope = residuals.slopes[number * problem.unknowns() + static_cast<size_t>(k)];
      slopes(i, k) = slope * std::sqrt(weight);
      changes(column, k) = Hypot(changes(column, k), slopes(i, k));
      fall[k] -= weight * residual * slope;
    }
  }
  // An input that is held at the end of its range counts as one more measured number.
  const auto end_of_numbers = residuals.values.begin() + count;
  std::for_each(end_of_numbers, residuals.values.end(), [&](double residual) { chi2 += residual * residual; });
  Eigen::VectorXd lengths = slopes.colwise().norm().transpose();
  const double nothing = NothingOf(problem);
  Information information = {.chi2 = chi2, .is_seen = std::vector<bool>(problem.unknowns(), true)};
  information.row_shares.resize(problem.unknowns());
  for (Eigen::Index k = 0; k < size; ++k) {
    const auto unknown = static_cast<size_t>(k);
    const double scale = std::max(problem.scale[unknown], std::fabs(at[unknown]));
    const bool is_nothing = !(changes.col(k).array() * scale > nothing * numbers.array()).any();
    if (!is_nothing) information.row_shares[unknown] = SharesOf(problem, slopes.col(k));
    information.is_seen[unknown] = !is_nothing;
    slopes.col(k) *= is_nothing ? 0.0 : 1.0 / lengths[k];
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> parts(FewRowsOf(slopes, stopped), Eigen::ComputeThinU | Eigen::ComputeThinV);
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index j = 0; j < parts.singularValues().size(); ++j) {
    const Eigen::VectorXd part = parts.matrixV().col(j);
    const double value = parts.singularValues()[j];
    if (value > nothing) {
      ++information.rank;
      inverse += part * part.transpose() / (value * value);
      continue;
    }
    for (Eigen::Index k = 0; k < size; ++k) {
      if (std::fabs(part[k]) > kLeastPart) information.is_seen[static_cast<size_t>(k)] = false;
    }
  }
  for (Eigen::Index k = 0; k < size; ++k) {
    const auto unknown = static_cast<size_t>(k);
    const bool is_low = at[unknown] <= problem.low[unknown] && fall[k] < 0.0;
    const bool is_high = at[unknown] >= problem.high[unknown] && fall[k] > 0.0;
    information.is_at_bound.push_back(information.is_seen[unknown] && (is_low || is_high));
  }
  // An unknown at a bound is no more free than one that is given.
  information.degrees_of_freedom = count - static_cast<int64_t>(information.rank) + residuals.held_inputs +
                                   std::count(information.is_at_bound.begin(), information.is_at_bound.end(), true);
  const Spread spread = SpreadOf(problem, {residuals.values.begin(), end_of_numbers}, information.degrees_of_freedom);
  information.rise = spread.rise;
  // J^T J of the weighted residuals is that of all residuals times the mean weight.
  const double variance = spread.variance * (weights / static_cast<double>(count));
  for (Eigen::Index k = 0; k < size; ++k) {
    for (Eigen::Index j = 0; j < size; ++j) {
      const bool both = information.is_seen[static_cast<size_t>(k)] && information.is_seen[static_cast<size_t>(j)];
      information.covariance.push_back(both ? variance * inverse(k, j) / (lengths[k] * lengths[j]) : kNone);
      information.correlation.push_back(both ? inverse(k, j) / std::sqrt(inverse(k, k) * inverse(j, j)) : kNone);
    }
  }
  return information;
}

double ChiSquaredBeyond(double value, double degrees_of_freedom) {
  return Eigen::numext::igammac(0.5 * degrees_of_freedom, 0.5 * value);
}

std::optional<double> PValueOf(const Information& information) {
  if (information.degrees_of_freedom <= 0) return std::nullopt;
  return ChiSquaredBeyond(information.chi2, static_cast<double>(information.degrees_of_freedom));
}

Spread SpreadOf(const Problem& problem, const std::vector<double>& residuals, int64_t degrees_of_freedom) {
  if (problem.loss == FitLoss::kSquares) return {};
  const Sums normal = NormalMeans(problem);
  double square = normal.square, slope = normal.slope;
  if (degrees_of_freedom > 0) {
    Sums seen;
    for (const double residual : residuals) seen.Add(problem, residual, 1.0);
    square = std::max(square, seen.square / static_cast<double>(degrees_of_freedom));
    slope = std::clamp(seen.slope / static_cast<double>(residuals.size()), 0.5 * normal.slope, normal.slope);
  }
  return {.rise = square / slope, .variance = square / (slope * slope)};
}

}  // namespace ricochet::fit
