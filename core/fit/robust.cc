#include "core/fit/robust.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/fit/search.h"
#include "core/numerics/elementary.h"

namespace ricochet::fit {
namespace {

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
