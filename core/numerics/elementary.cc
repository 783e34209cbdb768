#include "core/numerics/elementary.h"

#include <sleef.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ricochet {

double Sin(double radians) { return Sleef_cinz_sind1_u10purec(radians); }
double Cos(double radians) { return Sleef_cinz_cosd1_u10purec(radians); }
double Exp(double x) { return Sleef_cinz_expd1_u10purec(x); }
double Log(double x) { return Sleef_cinz_logd1_u10purec(x); }
double Pow(double base, double exponent) { return Sleef_cinz_powd1_u10purec(base, exponent); }

// Scales the arguments by a power of two, and corrects the root for the rounding errors of both squares and of their
// sum.
double Hypot(double x, double y) {
  const double large = std::max(std::fabs(x), std::fabs(y));
  if (std::isinf(x) || std::isinf(y)) return std::numeric_limits<double>::infinity();
  if (!(large > 0.0)) return x + y + large;
  const int exponent = std::ilogb(large);
  const double a = std::scalbn(large, -exponent);
  const double b = std::scalbn(std::min(std::fabs(x), std::fabs(y)), -exponent);
  const double square = a * a;
  const double sum = std::fma(b, b, square);
  const double rest = std::fma(b, b, square - sum) + std::fma(a, a, -square);
  const double root = std::sqrt(sum);
  return std::scalbn(root + (std::fma(-root, root, sum) + rest) / (root + root), exponent);
}

}  // namespace ricochet
