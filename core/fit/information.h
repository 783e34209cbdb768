// Information: what the residuals at a fit tell about each unknown, by their derivatives.
//
// With the weighted residuals r(x) and J = dr/dx, the covariance of the unknowns is (J^T J)^-1, times what a robust
// loss adds (core/fit/robust.h). J is divided by the lengths of its columns and decomposed into singular values, so
// that no units matter. An unknown is not seen by itself, and has no variance, if its column of J counts as 0 or if it
// has a part of a combination whose singular value counts as 0.

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

}  // namespace ricochet::fit

#endif  // RICOCHET_CORE_FIT_INFORMATION_H_
