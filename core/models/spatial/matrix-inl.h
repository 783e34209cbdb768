// The Delassus matrix of the spatial solver, as seen from a direction of slip: how the contact sticks, and in which
// direction slip starts again.

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

#include "core/contact/delassus.h"
#include "core/numerics/double_double-inl.h"
#include "core/numerics/lane_number-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::spatial::HWY_NAMESPACE {

using ricochet::HWY_NAMESPACE::Absolute;
using ricochet::HWY_NAMESPACE::Both;
using ricochet::HWY_NAMESPACE::Constant;
using ricochet::HWY_NAMESPACE::CopySign;
using ricochet::HWY_NAMESPACE::Differ;
using ricochet::HWY_NAMESPACE::Either;
using ricochet::HWY_NAMESPACE::InNoLane;
using ricochet::HWY_NAMESPACE::MaskOf;
using ricochet::HWY_NAMESPACE::Max;
using ricochet::HWY_NAMESPACE::Min;
using ricochet::HWY_NAMESPACE::Not;
using ricochet::HWY_NAMESPACE::Select;
using ricochet::HWY_NAMESPACE::SquareRoot;
#if RICOCHET_SIMD
using ricochet::HWY_NAMESPACE::LaneNumber;
#endif

// A unit vector e = (c, s) = (cos phi, sin phi) in the tangent plane.
template <typename T>
struct Direction {
  T c, s;
};

// The direction of (x, y), which must not be zero.
template <typename T>
Direction<T> Normalized(T x, T y) {
  const T inverse = T{1} / std::sqrt(x * x + y * y);
  return {x * inverse, y * inverse};
}

// Returns the power of two that brings numbers of about `size` near 1; 1 where their squares are normal doubles.
template <typename T>
T ScaleForSquares(T size) {
  const bool is_moderate = size == T{0} || (size >= T{0x1p-400} && size <= T{0x1p400});
  return is_moderate ? T{1} : std::ldexp(T{1}, std::clamp(-std::ilogb(size), -1022, 1023));
}

// The matrix A = -mu Wtt and the vector wtn by their components along (1) and across (2) a direction e = (c, s), both
// divided by the rate mu |Wtt| + |wtn|, so that no component exceeds 1.
template <typename T>
struct Frame {
  T c, s;
  T a11, a12, a22;
  T w1, w2;

  T Growth() const { return a11 + w1; }           // d(slip)/dxi over slip
  T Turn() const { return a12 + w2; }             // g = dphi/dxi of slip along e
  T TurnSlope() const { return a22 - a11 - w1; }  // dg/dphi
};

// Slopes of the contact velocity over the normal impulse tau.
template <typename T>
struct Slopes {
  T u1, u2, v;
  T bend{0};  // |d2v/dtau2|, which slip that turns has
};

// A contact that sticks: the friction impulse per normal impulse that keeps u as it is, with the smallest norm if there
// is a choice.
template <typename T>
struct Sticking {
  T f1, f2;
  T v_slope;   // dv/dtau; 0 where W has the same rank as Wtt.
  bool holds;  // The friction impulse lies within the cone of static friction.
};

// Entries are exact doubles; the largest one on the diagonal lies in [1/2, 1).
template <typename T>
struct Matrix {
  Matrix() = default;
  Matrix(double e11, double e12, double e13, double e22, double e23, double e33, int rank_of_all)
      : w11(e11), w12(e12), w13(e13), w22(e22), w23(e23), w33(e33), rank(rank_of_all) {
    // If W is singular, either Wtt is singular, or v has no direction of its own beside u. What tells these two apart
    // has the rounding of a sum of products.
    const double noise = rank < 3 ? 16.0 * kRankTolerance : kRankTolerance;
    const PlanarDelassus tangent = {.tt = e11, .tn = e12, .nn = e22};
    tangent_is_singular = TangentDeterminant() <= T{0} || tangent.RelativeDeterminant() <= noise;
  }

  T TangentDeterminant() const {
    const T square = w12 * w12;
    const T rounding = std::fma(-w12, w12, square);
    return std::fma(w11, w22, -square) + rounding;
  }
  T LargestTangentEigenvalue() const {
    const T half_difference = T{0.5} * (w11 - w22);
    return T{0.5} * (w11 + w22) + std::sqrt(half_difference * half_difference + w12 * w12);
  }
  bool HasNoTangentialMobility() const { return w11 == T{0} && w22 == T{0}; }
  Sticking<T> Stick(T mu_static) const;
  // The direction d of a singular Wtt = trace d d^T.
  Direction<T> TangentDirection() const { return w11 >= w22 ? Normalized(w11, w12) : Normalized(w12, w22); }
  // The one direction e in which slip grows from a stop: -mu Wtt e + wtn = h e with h > 0. It exists if the contact
  // cannot stick, |Wtt^-1 wtn| > mu.
  Direction<T> Restart(T mu) const;

  T w11, w12, w13, w22, w23, w33;
  int rank;
  bool tangent_is_singular;  // Wtt is singular within the rounding of its entries
};

template <typename T>
Sticking<T> Matrix<T>::Stick(T mu_static) const {
  using N = ricochet::HWY_NAMESPACE::DoubleDouble<double>;
  const auto exactly = [](T value) { return N::Exactly(static_cast<double>(value)); };
  const auto rounded = [](const N& value) { return static_cast<T>(value.hi) + static_cast<T>(value.lo); };
  const N a = exactly(w11), b = exactly(w12), c = exactly(w22), p = exactly(w13), q = exactly(w23), n = exactly(w33);
  const N limit = exactly(mu_static);
  // f' = -top/bottom, by Cramer's rule or, where Wtt is singular, by its pseudoinverse Wtt/(trace Wtt)^2.
  const bool singular = tangent_is_singular;
  const N bottom = singular ? (a + c) * (a + c) : a * c - b * b;
  const N top1 = singular ? a * p + b * q : c * p - b * q;
  const N top2 = singular ? b * p + c * q : a * q - b * p;
  if (bottom.hi <= 0.0) return {T{0}, T{0}, w33, true};
  constexpr double kRounding = 0x1p-96;
  const N cone = limit * bottom;
  const double scale = ScaleForSquares(std::max({std::fabs(top1.hi), std::fabs(top2.hi), cone.hi}));
  const auto scaled_square = [scale](const N& x) {
    const N scaled = {x.hi * scale, x.lo * scale};
    return scaled * scaled;
  };
  const N square = scaled_square(top1) + scaled_square(top2);
  const bool holds = rounded(square - scaled_square(cone)) <= kRounding * square.hi;
  const bool locked = rank < (singular ? 2 : 3);
  const T v_slope = locked ? T{0} : std::max(rounded(n - (p * top1 + q * top2) / bottom), T{0});
  return {rounded(-(top1 / bottom)), rounded(-(top2 / bottom)), v_slope, holds};
}

// In the principal axes of Wtt the components are e_i = w_i/(h + mu lambda_i), and |e| = 1 is a secular equation for h.
// Newton's method on 1/|e| comes up to the root from below, monotonically (Hebden 1973; More and Sorensen 1983).
template <typename T>
Direction<T> Matrix<T>::Restart(T mu) const {
  const T largest = LargestTangentEigenvalue();
  const T smallest = largest > T{0} ? std::max(TangentDeterminant() / largest, T{0}) : T{0};
  const Direction<T> axis = largest > smallest
                                ? (w11 >= w22 ? Normalized(largest - w22, w12) : Normalized(w12, largest - w11))
                                : Direction<T>{T{1}, T{0}};
  T w1 = axis.c * w13 + axis.s * w23;
  T w2 = tangent_is_singular ? T{0} : axis.c * w23 - axis.s * w13;
  // e does not change with a factor of all numbers.
  const T scale = ScaleForSquares(std::max(std::fabs(w1), std::fabs(w2)));
  w1 *= scale;
  w2 *= scale;
  const T most = mu * largest * scale;
  const T least = mu * smallest * scale;
  T h = std::max(std::sqrt(w1 * w1 + w2 * w2) - most, T{0});
  T e1{1};
  T e2{0};
  constexpr int kEnough = 100;
  for (int i = 0; i < kEnough; ++i) {
    e1 = w1 / (h + most);
    e2 = w2 == T{0} ? T{0} : w2 / (h + least);
    const T square = e1 * e1 + e2 * e2;
    const T size = std::sqrt(square);
    const T descent = e1 * e1 / (h + most) + (e2 == T{0} ? T{0} : e2 * e2 / (h + least));
    const T step = (size - T{1}) * square / descent;
    if (!(step > std::numeric_limits<T>::epsilon() * h)) break;
    h += step;
  }
  return Normalized(axis.c * e1 - axis.s * e2, axis.s * e1 + axis.c * e2);
}

}  // namespace ricochet::spatial::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
