// The Taylor series of slip: one step of Keller's equations as power series in xi, where dtau = s dxi.
//
// Slip obeys du/dxi = A u + s wtn, where u is the tangential velocity, s = |u| and A = -mu Wtt. This is homogeneous:
// each series starts from u = (1, 0) in the frame of its own direction, and needs neither sine nor angle. Its
// coefficients follow from (k + 1) u_{k+1} = A u_k + s_k wtn and (s s)_k = (x x)_k + (y y)_k.
// Accuracy: the last two terms are not used but tell the error, and the fall of the terms what follows them. Sums and
// products only, hence the same bits on every machine. T is a floating type or a LaneNumber.
// Source: Keller (1986); docs/theory/spatial.md.

// Per-target include guard.
#if defined(RICOCHET_CORE_MODELS_SPATIAL_SERIES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_MODELS_SPATIAL_SERIES_INL_H_
#undef RICOCHET_CORE_MODELS_SPATIAL_SERIES_INL_H_
#else
#define RICOCHET_CORE_MODELS_SPATIAL_SERIES_INL_H_
#endif

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "core/models/spatial/matrix-inl.h"
#include "core/numerics/lane_number-inl.h"

// Sanitizers watch every access: all terms of all orders in one function would take a compiler minutes.
#undef RICOCHET_UNROLLED
#if HWY_IS_ASAN || defined(__SANITIZE_ADDRESS__)
#define RICOCHET_UNROLLED HWY_NOINLINE
#else
#define RICOCHET_UNROLLED HWY_INLINE
#endif

HWY_BEFORE_NAMESPACE();
namespace ricochet::spatial::HWY_NAMESPACE {

inline constexpr int kMaxOrder = 26;

namespace internal {

template <typename T>
constexpr auto MakeInverses() {
  std::array<T, kMaxOrder + 2> inverses = {};
  for (int k = 1; k < kMaxOrder + 2; ++k) inverses[static_cast<size_t>(k)] = T{1} / static_cast<T>(k);
  return inverses;
}
template <typename T>
inline constexpr auto kInverses = MakeInverses<T>();

// Approximates x^(1/k) from below, within 10 %. A step size needs no more, and pow of the C library does not have the
// same bits everywhere. The bits of a double are its logarithm, piecewise linear.
inline double RoughRoot(double x, int k) {
  constexpr auto kOne = std::bit_cast<int64_t>(1.0);
  const double logarithm =
      static_cast<double>(std::bit_cast<int64_t>(x) - kOne) * kInverses<double>[static_cast<size_t>(k)];
  return 0.94 * std::bit_cast<double>(kOne + static_cast<int64_t>(logarithm));
}
inline long double RoughRoot(long double x, int k) { return RoughRoot(static_cast<double>(x), k); }

#if RICOCHET_SIMD
HWY_INLINE LaneNumber RoughRoot(LaneNumber x, int k) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::ScalableTag<double> numbers;
  const hn::ScalableTag<int64_t> whole;
  const auto one = hn::Set(whole, std::bit_cast<int64_t>(1.0));
  const auto logarithm = hn::ConvertTo(numbers, hn::BitCast(whole, x.value) - one) *
                         hn::Set(numbers, kInverses<double>[static_cast<size_t>(k)]);
  return LaneNumber{0.94} * LaneNumber(hn::BitCast(numbers, one + hn::ConvertTo(whole, logarithm)));
}
#endif

template <typename T>
HWY_INLINE T Power(T x, int k) {
  T power{1};
  for (; k > 0; k >>= 1) {
    if (k & 1) power *= x;
    x *= x;
  }
  return power;
}

}  // namespace internal

// Integrals over xi of a slip that starts as 1, and that slip itself.
template <typename T>
struct SeriesValues {
  T x_integral, y_integral;  // int u
  T s_integral;              // int s
  T square_integral;         // int s^2
  T x, y;                    // u
  T trapezoid_excess;        // (u(0) + u)/2 . int u - int s^2, without the terms of first order, which cancel
};

// One term of the integrals over xi.
template <typename T>
struct SeriesTerm {
  T x_integral, y_integral, s_integral, square_integral;
};

// The last two terms at some xi, which are not used but tell the error.
template <typename T>
struct LastTerms {
  SeriesTerm<T> before, last;
  T ratio;  // By how much a term is smaller than the one before it, at most.
};

template <typename T>
class SlipSeries {
 public:
  // Code exists for the orders 8, 9, 11, 14, 17, 20 and kMaxOrder, which replaces every other order.
  void Expand(const Frame<T>& frame, int order);
  // The sums of all terms but the last two.
  SeriesValues<T> At(T xi) const;
  LastTerms<T> LastTermsAt(T xi) const;

  // The largest xi at which neither of the last two terms exceeds `bound` in an integral of u or s, nor `square_bound`
  // in the integral of s^2, which converges more slowly.
  T LongestStep(T bound, T square_bound) const;

 private:
  HWY_INLINE T Size(int k) const {
    return Absolute(x_integral_[Index(k)]) + Absolute(y_integral_[Index(k)]) + Absolute(s_integral_[Index(k)]);
  }
  // The factor by which each further term is smaller than the one before it, judged by the last four or eight terms.
  // Both are needed, because a complex pair of singularities makes terms oscillate, and some of them are small by
  // chance.
  HWY_INLINE T Fall() const {
    const T smallest{1e-290};
    const T roughness{1.1};
    const T last = Size(order_ + 1) + smallest;
    const auto root = [&](int span) HWY_ATTR {
      return roughness * internal::RoughRoot(last / (Size(order_ + 1 - span) + smallest), span);
    };
    return order_ < 9 ? root(4) : Max(root(4), root(8));
  }
  static size_t Index(int k) { return static_cast<size_t>(k); }

  using Coefficients = std::array<T, kMaxOrder + 2>;
  template <size_t kOrder, size_t k>
  void Terms();
  template <size_t m, size_t i>
  void Products(T& u_terms, T& s_terms) const;

  Frame<T> frame_;
  int order_ = 0;
  T square_;  // the newest coefficient of s^2
  Coefficients x_, y_, s_;
  Coefficients x_integral_, y_integral_, s_integral_, square_integral_;
};

template <typename T>
void SlipSeries<T>::Expand(const Frame<T>& frame, int order) {
  frame_ = frame;
  order_ = order;
  x_[0] = s_[0] = square_ = T{1};
  y_[0] = T{0};
  switch (order) {
    case 8:
      return Terms<8, 0>();
    case 9:
      return Terms<9, 0>();
    case 11:
      return Terms<11, 0>();
    case 14:
      return Terms<14, 0>();
    case 17:
      return Terms<17, 0>();
    case 20:
      return Terms<20, 0>();
    default:
      order_ = kMaxOrder;
      return Terms<kMaxOrder, 0>();
  }
}

// Templates unroll the loops over terms, whose changing counts a processor predicts badly.
template <typename T>
template <size_t kOrder, size_t k>
RICOCHET_UNROLLED void SlipSeries<T>::Terms() {
  const T inverse{internal::kInverses<Constant<T>>[k + 1]};
  const T x = x_integral_[k + 1] = x_[k] * inverse;
  const T y = y_integral_[k + 1] = y_[k] * inverse;
  const T s = s_integral_[k + 1] = s_[k] * inverse;
  square_integral_[k + 1] = square_ * inverse;
  if constexpr (k < kOrder) {
    constexpr size_t kNext = k + 1;
    x_[kNext] = frame_.a11 * x + frame_.a12 * y + frame_.w1 * s;
    y_[kNext] = frame_.a12 * x + frame_.a22 * y + frame_.w2 * s;
    T u_terms{0};
    T s_terms{0};
    if constexpr (kNext % 2 == 0) {
      constexpr size_t kHalf = kNext / 2;
      u_terms = T{0.5} * (x_[kHalf] * x_[kHalf] + y_[kHalf] * y_[kHalf]);
      s_terms = T{0.5} * s_[kHalf] * s_[kHalf];
    }
    Products<kNext, (kNext - 1) / 2>(u_terms, s_terms);
    s_[kNext] = x_[kNext] + (u_terms - s_terms);
    square_ = T{2} * (x_[kNext] + u_terms);
    Terms<kOrder, kNext>();
  }
}

// Adds the products with i + j = m and 0 < i < j, the newest coefficients last.
template <typename T>
template <size_t m, size_t i>
HWY_INLINE void SlipSeries<T>::Products(T& u_terms, T& s_terms) const {
  if constexpr (i > 0) {
    u_terms += x_[i] * x_[m - i] + y_[i] * y_[m - i];
    s_terms += s_[i] * s_[m - i];
    Products<m, i - 1>(u_terms, s_terms);
  }
}

template <typename T>
RICOCHET_UNROLLED SeriesValues<T> SlipSeries<T>::At(T xi) const {
  T x{0};
  T y{0};
  T s{0};
  T square{0};
  for (size_t k = Index(order_ - 1); k >= 2; --k) {
    x = x * xi + x_integral_[k];
    y = y * xi + y_integral_[k];
    s = s * xi + s_integral_[k];
    square = square * xi + square_integral_[k];
  }
  // The first terms of the integrals are xi, 0, xi and xi.
  const T one{1};
  const T x_rest = x * xi;
  const T y_mean = y * xi;
  const T square_rest = square * xi;
  x = (x_rest + one) * xi;
  y = y_mean * xi;
  s = (s * xi + one) * xi;
  const T x_change = frame_.a11 * x + frame_.a12 * y + frame_.w1 * s;
  const T y_slip = frame_.a12 * x + frame_.a22 * y + frame_.w2 * s;
  const T mean_change = T{0.5} * (x_change + (x_rest * x_change + y_mean * y_slip));
  return {.x_integral = x,
          .y_integral = y,
          .s_integral = s,
          .square_integral = (square_rest + one) * xi,
          .x = one + x_change,
          .y = y_slip,
          .trapezoid_excess = xi * (mean_change + (x_rest - square_rest))};
}

template <typename T>
HWY_INLINE LastTerms<T> SlipSeries<T>::LastTermsAt(T xi) const {
  const T largest_ratio{0.8};
  const auto term = [this](int k, T power) HWY_ATTR {
    const size_t i = Index(k);
    return SeriesTerm<T>{power * x_integral_[i], power * y_integral_[i], power * s_integral_[i],
                         power * square_integral_[i]};
  };
  const T power = internal::Power(xi, order_);
  return {term(order_, power), term(order_ + 1, power * xi), Min(Fall() * xi, largest_ratio)};
}

template <typename T>
HWY_INLINE T SlipSeries<T>::LongestStep(T bound, T square_bound) const {
  const T smallest{1e-300};
  const auto step_for = [&](int k) HWY_ATTR {
    const T size = Max(Size(k) / bound, Absolute(square_integral_[Index(k)]) / square_bound);
    return internal::RoughRoot(T{1} / (size + smallest), k);
  };
  return Min(step_for(order_), step_for(order_ + 1));
}

}  // namespace ricochet::spatial::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
