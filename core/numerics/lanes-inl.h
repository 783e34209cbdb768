// Lanes: one vocabulary for a double and for a SIMD vector of doubles, so that an algorithm is written once.
//
// V is `double` or a Highway vector; its masks are `bool` or the vector's masks. Like Highway's own headers, this one
// is included once for each target, and everything here lives in HWY_NAMESPACE. Vectors exist only on targets with a
// hardware fma (RICOCHET_SIMD); elsewhere V is `double` and std::fma gives the same bits.

// Per-target include guard.
#if defined(RICOCHET_CORE_NUMERICS_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_NUMERICS_LANES_INL_H_
#undef RICOCHET_CORE_NUMERICS_LANES_INL_H_
#else
#define RICOCHET_CORE_NUMERICS_LANES_INL_H_
#endif

#include <cmath>
#include <cstddef>

#include "hwy/highway.h"

#undef RICOCHET_SIMD
#if HWY_NATIVE_FMA
#define RICOCHET_SIMD 1
#else
#define RICOCHET_SIMD 0
#endif

HWY_BEFORE_NAMESPACE();
namespace ricochet::HWY_NAMESPACE {

// The following compute a b + c, a b - c and c - a b with one rounding.
HWY_INLINE double Fma(double a, double b, double c) { return std::fma(a, b, c); }
HWY_INLINE double FmaSubtract(double a, double b, double c) { return std::fma(a, b, -c); }
HWY_INLINE double NegativeFma(double a, double b, double c) { return std::fma(-a, b, c); }
HWY_INLINE double SquareRoot(double x) { return std::sqrt(x); }
HWY_INLINE double Absolute(double x) { return std::fabs(x); }
HWY_INLINE double CopySign(double size, double sign) { return std::copysign(size, sign); }
HWY_INLINE double Smaller(double x, double y) { return x < y ? x : y; }
HWY_INLINE double Larger(double x, double y) { return x < y ? y : x; }
HWY_INLINE double Select(bool condition, double yes, double no) { return condition ? yes : no; }
HWY_INLINE bool Not(bool x) { return !x; }
HWY_INLINE bool Both(bool x, bool y) { return x && y; }
HWY_INLINE bool Either(bool x, bool y) { return x || y; }
HWY_INLINE bool SelectMask(bool condition, bool yes, bool no) { return condition ? yes : no; }
HWY_INLINE bool InAllLanes(bool x) { return x; }
HWY_INLINE bool InNoLane(bool x) { return !x; }

// Lanes<V> loads a V from memory, or fills every lane with one value.
template <typename V>
struct Lanes;

template <>
struct Lanes<double> {
  static constexpr size_t Count() { return 1; }
  HWY_INLINE static double Fill(double value) { return value; }
  HWY_INLINE static double Load(const double* from) { return *from; }
  HWY_INLINE static void Store(double value, double* to) { *to = value; }
};

#if RICOCHET_SIMD
namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::ScalableTag<double>;
using Vector = hn::Vec<Tag>;
using VectorMask = hn::Mask<Tag>;

HWY_INLINE Vector Fma(Vector a, Vector b, Vector c) { return hn::MulAdd(a, b, c); }
HWY_INLINE Vector FmaSubtract(Vector a, Vector b, Vector c) { return hn::MulSub(a, b, c); }
HWY_INLINE Vector NegativeFma(Vector a, Vector b, Vector c) { return hn::NegMulAdd(a, b, c); }
HWY_INLINE Vector SquareRoot(Vector x) { return hn::Sqrt(x); }
HWY_INLINE Vector Absolute(Vector x) { return hn::Abs(x); }
HWY_INLINE Vector CopySign(Vector size, Vector sign) { return hn::CopySign(size, sign); }
HWY_INLINE Vector Smaller(Vector x, Vector y) { return hn::Min(x, y); }
HWY_INLINE Vector Larger(Vector x, Vector y) { return hn::Max(x, y); }
HWY_INLINE Vector Select(VectorMask condition, Vector yes, Vector no) { return hn::IfThenElse(condition, yes, no); }
HWY_INLINE VectorMask Not(VectorMask x) { return hn::Not(x); }
HWY_INLINE VectorMask Both(VectorMask x, VectorMask y) { return hn::And(x, y); }
HWY_INLINE VectorMask Either(VectorMask x, VectorMask y) { return hn::Or(x, y); }
HWY_INLINE VectorMask SelectMask(VectorMask condition, VectorMask yes, VectorMask no) {
  return hn::Or(hn::And(condition, yes), hn::AndNot(condition, no));
}
HWY_INLINE bool InAllLanes(VectorMask x) { return hn::AllTrue(Tag(), x); }
HWY_INLINE bool InNoLane(VectorMask x) { return hn::AllFalse(Tag(), x); }

template <>
struct Lanes<Vector> {
  static size_t Count() { return hn::Lanes(Tag()); }
  HWY_INLINE static Vector Fill(double value) { return hn::Set(Tag(), value); }
  HWY_INLINE static Vector Load(const double* from) { return hn::LoadU(Tag(), from); }
  HWY_INLINE static void Store(Vector value, double* to) { hn::StoreU(value, Tag(), to); }
};
#else
using Vector = double;
#endif

}  // namespace ricochet::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
