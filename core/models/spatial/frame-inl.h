// Directions in the tangent plane, and the equations of slip seen from one of them.

// Per-target include guard.
#if defined(RICOCHET_CORE_MODELS_SPATIAL_FRAME_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_MODELS_SPATIAL_FRAME_INL_H_
#undef RICOCHET_CORE_MODELS_SPATIAL_FRAME_INL_H_
#else
#define RICOCHET_CORE_MODELS_SPATIAL_FRAME_INL_H_
#endif

#include <cmath>

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::spatial::HWY_NAMESPACE {

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

// The matrix A = -mu Wtt and the vector wtn by their components along (1) and across (2) a direction e = (c, s), both
// divided by the rate mu |Wtt| + |wtn|, so that no component exceeds 1.
template <typename T>
struct Frame {
  T c, s;
  T a11, a12, a22;
  T w1, w2;

  T Turn() const { return a12 + w2; }             // g = dphi/dxi of slip along e
  T TurnSlope() const { return a22 - a11 - w1; }  // dg/dphi
};

// Slopes of the contact velocity over the normal impulse tau.
template <typename T>
struct Slopes {
  T u1, u2, v;
};

}  // namespace ricochet::spatial::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
