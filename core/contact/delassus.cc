#include "core/contact/delassus.h"

#include <algorithm>

namespace ricochet {

int SpatialDelassus::Rank() const {
  int exponent = 0;
  (void)std::frexp(std::max({w[0], w[3], w[5]}), &exponent);
  std::array<double, 6> scaled = {};
  // Where this power of two is a double, to multiply by it is to scale by its exponent.
  const double power = std::scalbn(1.0, -exponent);
  const bool is_double = std::isfinite(power);
  for (size_t i = 0; i < w.size(); ++i) scaled[i] = is_double ? w[i] * power : std::scalbn(w[i], -exponent);
  const auto& [w11, w12, w13, w22, w23, w33] = scaled;
  const double m11 = DifferenceOfProducts(w11, w33, w13, w13);
  const double m22 = DifferenceOfProducts(w22, w33, w23, w23);
  const double m12 = DifferenceOfProducts(w12, w33, w13, w23);
  if (!(m11 > kRankTolerance * w11 * w33) && !(m22 > kRankTolerance * w22 * w33)) return 1;
  const double noise =
      kRankTolerance * w33 * (std::fabs(m11) * w22 + std::fabs(m22) * w11 + 2.0 * std::fabs(m12 * w12));
  return m11 * m22 - m12 * m12 > noise ? 3 : 2;
}

}  // namespace ricochet
