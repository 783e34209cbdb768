// This file is compiled once for each SIMD target, as the kernels are.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/numerics/simd_target.cc"
#include "core/numerics/simd_target.h"

// Highway requires this order of includes.
// clang-format off
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace ricochet::HWY_NAMESPACE {

const char* NameOfTarget() { return hwy::TargetName(HWY_TARGET); }

}  // namespace ricochet::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace ricochet {

HWY_EXPORT(NameOfTarget);

const char* SimdTarget() { return HWY_DYNAMIC_DISPATCH(NameOfTarget)(); }

}  // namespace ricochet

#endif  // HWY_ONCE
