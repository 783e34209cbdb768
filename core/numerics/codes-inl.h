// Codes: a whole number in each lane, chosen by masks, such as the number of a regime and the flags of a verdict.
//
// V is `double` or a Highway vector. Codes<V>::Type has a 64-bit number for each of its lanes, so that the masks of V
// select among codes as they do among values.

// Per-target include guard.
#if defined(RICOCHET_CORE_NUMERICS_CODES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_NUMERICS_CODES_INL_H_
#undef RICOCHET_CORE_NUMERICS_CODES_INL_H_
#else
#define RICOCHET_CORE_NUMERICS_CODES_INL_H_
#endif

#include <cstdint>

#include "core/numerics/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::HWY_NAMESPACE {

// Codes<V> fills every lane with one code, or stores the codes of all lanes.
template <typename V>
struct Codes;

template <>
struct Codes<double> {
  using Type = uint64_t;
  HWY_INLINE static Type Fill(uint64_t code) { return code; }
  HWY_INLINE static void Store(Type codes, uint64_t* to) { *to = codes; }
  HWY_INLINE static Type Select(bool condition, Type yes, Type no) { return condition ? yes : no; }
  // These two add a flag, a bit that no code has yet, where the condition holds, or where it does not.
  HWY_INLINE static Type FlagWhere(bool condition, uint64_t flag, Type codes) {
    return codes | (condition ? flag : uint64_t{0});
  }
  HWY_INLINE static Type FlagUnless(bool condition, uint64_t flag, Type codes) {
    return codes | (condition ? uint64_t{0} : flag);
  }
};

#if RICOCHET_SIMD
template <>
struct Codes<Vector> {
  using CodeTag = hn::RebindToUnsigned<Tag>;
  using Type = hn::Vec<CodeTag>;
  HWY_INLINE static Type Fill(uint64_t code) { return hn::Set(CodeTag(), code); }
  HWY_INLINE static void Store(Type codes, uint64_t* to) { hn::StoreU(codes, CodeTag(), to); }
  HWY_INLINE static Type Select(VectorMask condition, Type yes, Type no) {
    return hn::IfThenElse(hn::RebindMask(CodeTag(), condition), yes, no);
  }
  HWY_INLINE static Type FlagWhere(VectorMask condition, uint64_t flag, Type codes) {
    return hn::Or(codes, hn::IfThenElseZero(hn::RebindMask(CodeTag(), condition), Fill(flag)));
  }
  HWY_INLINE static Type FlagUnless(VectorMask condition, uint64_t flag, Type codes) {
    return hn::Or(codes, hn::IfThenZeroElse(hn::RebindMask(CodeTag(), condition), Fill(flag)));
  }
};
#endif

}  // namespace ricochet::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
