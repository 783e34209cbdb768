// DifferenceOfProducts: a difference of two products, accurate even if they cancel.

#ifndef RICOCHET_CORE_NUMERICS_PRODUCTS_H_
#define RICOCHET_CORE_NUMERICS_PRODUCTS_H_

#include <cmath>

namespace ricochet {

// Computes a b - c d to within 1.5 ulp (Jeannerod, Louvet and Muller, 2013). No product may overflow or underflow.
inline double DifferenceOfProducts(double a, double b, double c, double d) {
  const double cd = c * d;
  const double error = std::fma(-c, d, cd);
  return std::fma(a, b, -cd) + error;
}

}  // namespace ricochet

#endif  // RICOCHET_CORE_NUMERICS_PRODUCTS_H_
