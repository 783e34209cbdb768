// PathError: what the path that was found lacks of the true one at equal normal impulse, with signs, to first order.
//
// A lack df of the friction impulse is one of Wtt df in u and of wtn.df in v. Slip along e carries it on by
// d(df)/dtau = -(mu/s) e' (e'.Wtt df), where e' is across e: the part of Wtt df across slip decays, the part along slip
// stays. docs/theory/spatial.md has the derivation. T is a floating type or a LaneNumber.

// Per-target include guard.
#if defined(RICOCHET_CORE_MODELS_SPATIAL_PATH_ERROR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_MODELS_SPATIAL_PATH_ERROR_INL_H_
#undef RICOCHET_CORE_MODELS_SPATIAL_PATH_ERROR_INL_H_
#else
#define RICOCHET_CORE_MODELS_SPATIAL_PATH_ERROR_INL_H_
#endif

#include "core/models/spatial/matrix-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::spatial::HWY_NAMESPACE {

// Decay says how much a stretch of slip takes away from a lack df of the friction impulse.
template <typename T>
struct Decay {
  T a1{0}, a2{0};  // e', at any length
  T mobility{0};   // e'.Wtt e'
  T gone{0};       // the share of the part across slip that has decayed at the end,
  T mean_gone{0};  // and its mean over the stretch
  T length{0};     // of the stretch, in normal impulse
};

// A stretch of slip: its length in normal impulse, its mean direction at any length, and the sizes of slip at its ends.
template <typename T>
struct Stretch {
  T length;
  Direction<T> m;
  T first_slip, last_slip;
};

// The decay over a stretch of slip. `error` is that of slip: where it is as large as slip, it decays no faster than it
// would at a slip of its own size.
template <typename T>
HWY_INLINE Decay<T> DecayOver(const Matrix<T>& w, T mu, const Stretch<T>& stretch, T error) {
  const T zero{0};
  const T m1 = stretch.m.c;
  const T m2 = stretch.m.s;
  const T square = m1 * m1 + m2 * m2;
  const T mobility = m2 * m2 * w.w11 + m1 * m1 * w.w22 - T{2} * m1 * m2 * w.w12;
  const T first = stretch.first_slip + error;
  const T last = stretch.last_slip + error;
  const T rate = mu * mobility * stretch.length / square;
  // Slip changes linearly. The mean of 1/s is one over the logarithmic mean of its ends, which (2 G + A)/3 exceeds by
  // little, with the geometric mean G and the arithmetic mean A; 1/(1 + z + z^2/2) stands for exp(-z).
  const T z = Min(T{6} * rate / (T{4} * SquareRoot(first * last) + (first + last)), T{1e9});
  const T left = Select(last > zero, T{1} / (T{1} + z + T{0.5} * z * z), zero);
  // The mean over slip that slows is exact where slip stops.
  const T steady = rate / first;
  const T mean_gone = Select(last > first, T{0.5} * z * (T{1} + z) * left, steady / (T{1} + steady));
  return {.a1 = -m2,
          .a2 = m1,
          .mobility = Select(first + last > zero, mobility, zero),
          .gone = T{1} - left,
          .mean_gone = mean_gone,
          .length = stretch.length};
}

template <typename T>
struct PathError {
  T f1{0}, f2{0};  // of the friction impulse
  T work{0};       // of the normal work in this phase

  HWY_INLINE T Velocity1(const Matrix<T>& w) const { return w.w11 * f1 + w.w12 * f2; }
  HWY_INLINE T Velocity2(const Matrix<T>& w) const { return w.w12 * f1 + w.w22 * f2; }
  HWY_INLINE T NormalVelocity(const Matrix<T>& w) const { return w.w13 * f1 + w.w23 * f2; }
  // sqrt(df^T Wtt df), which never grows.
  HWY_INLINE T Norm(const Matrix<T>& w) const { return SquareRoot(Max(T{0}, f1 * Velocity1(w) + f2 * Velocity2(w))); }

  HWY_INLINE void Add(const PathError& other, T factor) {
    f1 += factor * other.f1;
    f2 += factor * other.f2;
    work += factor * other.work;
  }
  HWY_INLINE void CarryOver(const Matrix<T>& w, const Decay<T>& decay) {
    const auto decays = decay.mobility > T{0};
    const T before = NormalVelocity(w);
    const T across = (decay.a1 * Velocity1(w) + decay.a2 * Velocity2(w)) / decay.mobility;
    const T v_across = across * (w.w13 * decay.a1 + w.w23 * decay.a2);
    f1 = Select(decays, f1 - decay.gone * across * decay.a1, f1);
    f2 = Select(decays, f2 - decay.gone * across * decay.a2, f2);
    work += decay.length * Select(decays, before - decay.mean_gone * v_across, before);
  }
};

template <typename T>
HWY_INLINE PathError<T> Select(MaskOf<T> condition, const PathError<T>& yes, const PathError<T>& no) {
  return {.f1 = Select(condition, yes.f1, no.f1),
          .f2 = Select(condition, yes.f2, no.f2),
          .work = Select(condition, yes.work, no.work)};
}

}  // namespace ricochet::spatial::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
