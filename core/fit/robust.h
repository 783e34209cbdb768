// SpreadOf: how much wider a robust loss leaves the unknowns than least squares, for data with outliers or without.
//
// With psi(r) half the derivative of the loss, the objective at the true unknowns exceeds its least value by
// E[psi^2]/E[psi'] times chi-squared, and the covariance of the unknowns is E[psi^2]/E[psi']^2 times that of least
// squares (Huber, Robust Statistics, 1981, sections 6.6 and 7.6). For squares both factors are 1.

#ifndef RICOCHET_CORE_FIT_ROBUST_H_
#define RICOCHET_CORE_FIT_ROBUST_H_

#include <cstdint>
#include <vector>

#include "core/fit/problem.h"

namespace ricochet::fit {

struct Spread {
  double rise = 1.0;
  double variance = 1.0;
};

// Takes for each mean the less favourable of two: that of normal residuals with the stated sigmas, and that of the
// residuals at the best fit, where outliers are. But the mean of psi' counts as at least half that of normal residuals:
// no fit withstands more outliers than that. `residuals` are in sigmas.
Spread SpreadOf(const Problem& problem, const std::vector<double>& residuals, int64_t degrees_of_freedom);

}  // namespace ricochet::fit

#endif  // RICOCHET_CORE_FIT_ROBUST_H_
