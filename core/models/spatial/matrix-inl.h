// W as the spatial model sees it: scaled, its rank, how the contact sticks and where slip starts again.

// Per-target include guard.
#if defined(RICOCHET_CORE_MODELS_SPATIAL_MATRIX_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_MODELS_SPATIAL_MATRIX_INL_H_
#undef RICOCHET_CORE_MODELS_SPATIAL_MATRIX_INL_H_
#else
#define RICOCHET_CORE_MODELS_SPATIAL_MATRIX_INL_H_
#endif

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numerics/double_double-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::spatial::HWY_NAMESPACE {

// A unit vector of the tangent plane.
template <typename T>
struct Direction {
  T c, s;
};

template <typename T>
Direction<T> Normalized(T x, T y) {
  const T inverse = T{1} / std::sqrt(x * x + y * y);
  return {x * inverse, y * inverse};
}

// How the contact sticks: df/dtau of the smallest norm that keeps u, and dv/dtau.
template <typename T>
struct Sticking {
  T f1, f2;
  T v_slope;   // 0 where friction and the joints lock the body.
  bool holds;  // Within the static cone.
};

// Entries are exact doubles; the largest on the diagonal in [1/2, 1).
template <typename T>
struct Matrix {
  T w11, w12, w13, w22, w23, w33;

  // a d - b c to 1.5 ulp.
  static T Determinant(T a, T b, T c, T d) {
    const T product = b * c;
    const T rest = std::fma(-b, c, product);
    return std::fma(a, d, -product) + rest;
  }

  T TangentDeterminant() const { return Determinant(w11, w12, w12, w22); }
  // Within the rounding of its entries.
  bool TangentIsSingular() const { return TangentDeterminant() <= kRankTolerance * w11 * w22; }
  T LargestTangentEigenvalue() const {
    const T half_difference = T{0.5} * (w11 - w22);
    return T{0.5} * (w11 + w22) + std::sqrt(half_difference * half_difference + w12 * w12);
  }
  int Rank() const;
  Sticking<T> Stick(T mu_static) const;
  // The one direction e along which slip that stopped grows: -mu Wtt e + wtn = h e, h > 0. Needs |Wtt^-1 wtn| > mu.
  Direction<T> Restart(T mu) const;

  static constexpr double kRankTolerance = 4.0 * std::numeric_limits<double>::epsilon();
};

// W is rank deficient where its determinant is below what a rounding of its entries makes of it.
template <typename T>
int Matrix<T>::Rank() const {
  const T m11 = Determinant(w11, w13, w13, w33);
  const T m22 = Determinant(w22, w23, w23, w33);
  const T m12 = Determinant(w12, w13, w23, w33);
  const bool first = m11 > kRankTolerance * w11 * w33;
  const bool second = m22 > kRankTolerance * w22 * w33;
  if (!first && !second) return 1;
  const T noise = kRankTolerance * w33 * (std::fabs(m11) * w22 + std::fabs(m22) * w11 + T{2} * std::fabs(m12 * w12));
  return m11 * m22 - m12 * m12 > noise ? 3 : 2;
}

template <typename T>
Sticking<T> Matrix<T>::Stick(T mu_static) const {
  using N = ricochet::HWY_NAMESPACE::DoubleDouble<double>;
  const auto exactly = [](T value) { return N::Exactly(static_cast<double>(value)); };
  const auto rounded = [](const N& value) { return static_cast<T>(value.hi) + static_cast<T>(value.lo); };
  const N a = exactly(w11), b = exactly(w12), c = exactly(w22), p = exactly(w13), q = exactly(w23), n = exactly(w33);
  const N limit = exactly(mu_static);
  const bool singular = TangentIsSingular();
  // f' = -top/bottom
  const N bottom = singular ? (a + c) * (a + c) : a * c - b * b;
  const N top1 = singular ? a * p + b * q : c * p - b * q;
  const N top2 = singular ? b * p + c * q : a * q - b * p;
  if (bottom.hi <= 0.0) return {T{0}, T{0}, w33, true};
  const N reach = limit * bottom;
  const N square = top1 * top1 + top2 * top2;
  constexpr double kRounding = 0x1p-96;
  // No top is that large, but the square of `reach` would leave the range of doubles.
  constexpr double kBeyondAll = 0x1p400;
  const bool holds = reach.hi > kBeyondAll || rounded(square - reach * reach) <= kRounding * square.hi;
  const bool locked = Rank() < (singular ? 2 : 3);
  const T v_slope = locked ? T{0} : std::max(rounded(n - (p * top1 + q * top2) / bottom), T{0});
  return {rounded(-(top1 / bottom)), rounded(-(top2 / bottom)), v_slope, holds};
}

// In the principal axes of Wtt, e_i = w_i/(h + mu lambda_i): the secular equation |e| = 1, by Newton's method on 1/|e|,
// which comes up to the root from below, monotonic (Hebden; More and Sorensen 1983).
template <typename T>
Direction<T> Matrix<T>::Restart(T mu) const {
  const T largest = LargestTangentEigenvalue();
  const T smallest = largest > T{0} ? std::max(TangentDeterminant() / largest, T{0}) : T{0};
  const Direction<T> axis = largest > smallest
                                ? (w11 >= w22 ? Normalized(largest - w22, w12) : Normalized(w12, largest - w11))
                                : Direction<T>{T{1}, T{0}};
  const T w1 = axis.c * w13 + axis.s * w23;
  const T w2 = TangentIsSingular() ? T{0} : axis.c * w23 - axis.s * w13;
  T h = std::max(std::sqrt(w1 * w1 + w2 * w2) - mu * largest, T{0});
  T e1{1};
  T e2{0};
  constexpr int kEnough = 100;
  for (int i = 0; i < kEnough; ++i) {
    e1 = w1 / (h + mu * largest);
    e2 = w2 == T{0} ? T{0} : w2 / (h + mu * smallest);
    const T square = e1 * e1 + e2 * e2;
    const T size = std::sqrt(square);
    const T descent = e1 * e1 / (h + mu * largest) + (e2 == T{0} ? T{0} : e2 * e2 / (h + mu * smallest));
    const T step = (size - T{1}) * square / descent;
    if (!(step > std::numeric_limits<T>::epsilon() * h)) break;
    h += step;
  }
  return Normalized(axis.c * e1 - axis.s * e2, axis.s * e1 + axis.c * e2);
}

}  // namespace ricochet::spatial::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
