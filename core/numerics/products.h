// DifferenceOfProducts: a difference of two products, accurate even if they cancel. The determinant of a symmetric
// 2 x 2 matrix, relative to its diagonal, and whether two products agree, follow from it.

#ifndef RICOCHET_CORE_NUMERICS_PRODUCTS_H_
#define RICOCHET_CORE_NUMERICS_PRODUCTS_H_

#include <cmath>
#include <limits>

namespace ricochet {

// Computes a b - c d to within 1.5 ulp (Jeannerod, Louvet and Muller, 2013). No product may overflow or underflow.
inline double DifferenceOfProducts(double a, double b, double c, double d) {
  const double cd = c * d;
  const double error = std::fma(-c, d, cd);
  return std::fma(a, b, -cd) + error;
}

namespace determinant {

// Tells whether products of two such numbers, and their rounding errors, stay well within the range of doubles.
inline bool IsModerate(double value) { return std::abs(value) >= 0x1p-200 && std::abs(value) <= 0x1p200; }

inline double Quotient(double x, double y, double z) { return DifferenceOfProducts(x, z, y, y) / (x * z); }

}  // namespace determinant

// Computes (x z - y^2)/(x z) for x, z >= 0. It is 1 if y = 0, 0 for rank one, and negative for a matrix that is not
// positive semidefinite. If x z = 0, it is 0, or -infinity if y is not 0. It is NaN if x or z is. Scaling by powers of
// two makes it accurate over the whole range of doubles.
inline double RelativeDeterminant(double x, double y, double z) {
  // Powers of two change no bit of the quotient where nothing underflows or overflows.
  if (determinant::IsModerate(x) && determinant::IsModerate(z) && (y == 0.0 || determinant::IsModerate(y))) {
    return determinant::Quotient(x, y, z);
  }
  if (x == 0.0 || z == 0.0) return y == 0.0 ? 0.0 : -std::numeric_limits<double>::infinity();
  if (std::isnan(x) || std::isnan(z)) return std::numeric_limits<double>::quiet_NaN();
  const int i = std::ilogb(x) / 2;
  const int j = std::ilogb(z) / 2;
  return determinant::Quotient(std::scalbn(x, -2 * i), std::scalbn(y, -i - j), std::scalbn(z, -2 * j));
}

// Tells whether a b and c d differ by at most `tolerance`, which is below 1/8, times the sum of their sizes, over the
// whole range of doubles.
inline bool ProductsAgree(double a, double b, double c, double d, double tolerance) {
  const auto agree = [tolerance](double x, double y, double z, double w) {
    return std::abs(DifferenceOfProducts(x, y, z, w)) <= tolerance * (std::abs(x * y) + std::abs(z * w));
  };
  const auto is_exact = [](double value) { return value == 0.0 || determinant::IsModerate(value); };
  if (is_exact(a) && is_exact(b) && is_exact(c) && is_exact(d)) return agree(a, b, c, d);
  const bool is_zero = a == 0.0 || b == 0.0;
  if (is_zero || c == 0.0 || d == 0.0) return is_zero == (c == 0.0 || d == 0.0);
  const int size = std::ilogb(a) + std::ilogb(b);
  if (std::abs(std::ilogb(c) + std::ilogb(d) - size) > 2) return false;
  return agree(std::scalbn(a, -std::ilogb(a)), std::scalbn(b, -std::ilogb(b)), std::scalbn(c, -std::ilogb(c)),
               std::scalbn(d, std::ilogb(c) - size));
}

}  // namespace ricochet

#endif  // RICOCHET_CORE_NUMERICS_PRODUCTS_H_
