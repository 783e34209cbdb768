// Information: what the residuals at a fit tell about each unknown, by their derivatives.
//
// With the weighted residuals r(x) and J = dr/dx, the covariance of the unknowns is (J^T J)^-1, times what a robust
// loss adds (SpreadOf). J is divided by the lengths of its columns and decomposed into singular values, so that no
// units matter. An unknown is not seen by itself, and has no variance, if its column of J counts as 0 or if it has a
// part of a combination whose singular value counts as 0.

#ifndef RICOCHET_CORE_FIT_INFORMATION_H_
#define RICOCHET_CORE_FIT_INFORMATION_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "absl/functional/function_ref.h"
#include "core/fit/problem.h"

namespace ricochet::fit {

struct Information {
  double chi2 = 0.0;                            // The sum of the squared residuals, whatever the loss.
  size_t rank = 0;                              // Combinations of unknowns that are seen.
  std::vector<bool> is_at_bound;                // The objective would fall beyond the bound where the unknown is.
  int64_t degrees_of_freedom = 0;               // Measured numbers less the rank, and one for each unknown at a bound.
  std::vector<bool> is_seen;                    // By itself.
  std::vector<double> covariance, correlation;  // FitResponse explains both.
  double rise = 1.0;                            // That of the objective at the end of an interval, over chi-squared's.
  std::vector<std::vector<double>> row_shares;  // FitEstimate explains them; one list for each unknown.
};

// The residuals at some values of the unknowns, their slopes, and the sigmas of the numbers (core/fit/model.h).
struct LinearResiduals {
  std::vector<double> values, slopes, sigmas;
  int64_t held_inputs = 0;
};

// `residuals` are those at the unknowns `at`. Once `stopped` returns true, what is returned means nothing.
Information InformationOf(const Problem& problem, const std::vector<double>& at, const LinearResiduals& residuals,
                          absl::FunctionRef<bool()> stopped);

// The probability that chi-squared with so many degrees of freedom, > 0, exceeds a value, exact to some 1e-12 of 1.
double ChiSquaredBeyond(double value, double degrees_of_freedom);

// The probability of so large a chi2, or a larger one; none without a degree of freedom.
std::optional<double> PValueOf(const Information& information);

// How much wider a robust loss leaves the unknowns than least squares, for data with outliers or without.
//
// With psi(r) half the derivative of the loss, the objective at the true unknowns exceeds its least value by
// E[psi^2]/E[psi'] times chi-squared, and the covariance of the unknowns is E[psi^2]/E[psi']^2 times that of least
// squares (Huber, Robust Statistics, 1981, sections 6.6 and 7.6). For squares both factors are 1.
struct Spread {
  double rise = 1.0;
  double variance = 1.0;
};

// Takes for each mean the less favourable of two: that of normal residuals with the stated sigmas, and that of the
// residuals at the best fit, where outliers are. But the mean of psi' counts as at least half that of normal residuals:
// no fit withstands more outliers than that. `residuals` are in sigmas.
Spread SpreadOf(const Problem& problem, const std::vector<double>& residuals, int64_t degrees_of_freedom);

}  // namespace ricochet::fit

#endif  // RICOCHET_CORE_FIT_INFORMATION_H_
