// This file is compiled once for each SIMD target (foreach_target.h includes it again). The target is chosen at run
// time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/numerics/compensated_sums.cc"
#include "core/numerics/compensated_sums.h"

// Highway prescribes the order of these includes.
// clang-format off
#include "hwy/foreach_target.h"
#include "core/numerics/compensated_sum-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace ricochet::HWY_NAMESPACE {

CompensatedSum Dot(const double* x, const double* y, size_t count) {
  Sum<double> sum(0.0);
  for (size_t i = 0; i < count; ++i) sum.Add(x[i], y[i]);
  return {sum.value(), sum.size()};
}

CompensatedSum Dots(const double* x, const double* y, const double* z, const double* t, size_t count) {
  Sum<double> sum(0.0);
  for (size_t i = 0; i < count; ++i) sum.Add(x[i], y[i]);
  for (size_t i = 0; i < count; ++i) sum.Add(z[i], t[i]);
  return {sum.value(), sum.size()};
}

// The entries of the residual from `row` on, one in each lane. A column of A is a row of it.
template <typename V>
HWY_INLINE void ResidualAt(size_t row, const double* a, const double* x, const double* b, size_t n, double* residual,
                           double* sizes) {
  Sum<V> sum(Lanes<V>::Load(b + row));
  for (size_t k = 0; k < n; ++k) sum.Add(Lanes<V>::Load(a + k * n + row), Lanes<V>::Fill(-x[k]));
  Lanes<V>::Store(sum.value(), residual + row);
  Lanes<V>::Store(sum.size(), sizes + row);
}

void Residual(const double* a, const double* x, const double* b, size_t n, double* residual, double* sizes) {
  const size_t lanes = Lanes<Vector>::Count();
  if (n < lanes) {
    for (size_t row = 0; row < n; ++row) ResidualAt<double>(row, a, x, b, n, residual, sizes);
    return;
  }
  for (size_t row = 0; row + lanes <= n; row += lanes) ResidualAt<Vector>(row, a, x, b, n, residual, sizes);
  if (n % lanes != 0) ResidualAt<Vector>(n - lanes, a, x, b, n, residual, sizes);  // This computes some rows twice.
}

}  // namespace ricochet::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace ricochet {

HWY_EXPORT(Dot);
HWY_EXPORT(Dots);
HWY_EXPORT(Residual);

CompensatedSum CompensatedDot(const double* x, const double* y, size_t count) {
  return HWY_DYNAMIC_DISPATCH(Dot)(x, y, count);
}

CompensatedSum CompensatedDots(const double* x, const double* y, const double* z, const double* t, size_t count) {
  return HWY_DYNAMIC_DISPATCH(Dots)(x, y, z, t, count);
}

void CompensatedResidual(const double* a, const double* x, const double* b, size_t n, double* residual, double* sizes) {
  HWY_DYNAMIC_DISPATCH(Residual)(a, x, b, n, residual, sizes);
}

}  // namespace ricochet

#endif  // HWY_ONCE
