// SimdTarget: the name of the SIMD instructions that the kernels are dispatched to on this processor, such as "AVX2".

#ifndef RICOCHET_CORE_NUMERICS_SIMD_TARGET_H_
#define RICOCHET_CORE_NUMERICS_SIMD_TARGET_H_

namespace ricochet {

const char* SimdTarget();

}  // namespace ricochet

#endif  // RICOCHET_CORE_NUMERICS_SIMD_TARGET_H_
