// Sums of products as good as if they were computed in twice the precision and rounded once.
//
// With n products the error is at most u |sum| + (n u)^2/(1 - n u)^2 times the sum of the magnitudes of the products,
// u = 2^-53 (Ogita, Rump and Oishi, 2005, Proposition 5.5). No product may overflow or underflow.

#ifndef RICOCHET_CORE_NUMERICS_COMPENSATED_SUMS_H_
#define RICOCHET_CORE_NUMERICS_COMPENSATED_SUMS_H_

#include <cstddef>

namespace ricochet {

struct CompensatedSum {
  double value;
  double size;  // The sum of the magnitudes of the terms.
};

// x . y, for `count` numbers each.
CompensatedSum CompensatedDot(const double* x, const double* y, size_t count);

// x . y + z . t, for `count` numbers each.
CompensatedSum CompensatedDots(const double* x, const double* y, const double* z, const double* t, size_t count);

// b - A x for a symmetric A, n x n, and the sums of the magnitudes of the terms.
void CompensatedResidual(const double* a, const double* x, const double* b, size_t n, double* residual, double* sizes);

}  // namespace ricochet

#endif  // RICOCHET_CORE_NUMERICS_COMPENSATED_SUMS_H_
