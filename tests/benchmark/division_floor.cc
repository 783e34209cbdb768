// This file is compiled once for each SIMD target (foreach_target.h includes it again). The target is chosen at run
// time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/benchmark/division_floor.cc"
#include "tests/benchmark/division_floor.h"

#include "hwy/foreach_target.h"
// Highway prescribes the order of these includes.
#include "core/numerics/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::bench::HWY_NAMESPACE {

using ricochet::HWY_NAMESPACE::SquareRoot;
using V = ricochet::HWY_NAMESPACE::Vector;
using VLanes = ricochet::HWY_NAMESPACE::Lanes<V>;

void Run(int divisions, int roots, size_t count, const double* from, double* to) {
  for (size_t i = 0; i < count; i += VLanes::Count()) {
    const V x = VLanes::Load(from + i);
    V sum = x;
    V shifted = x;
    for (int k = 0; k < divisions; ++k) {
      shifted = shifted + x;
      sum = sum + x / shifted;
    }
    for (int k = 0; k < roots; ++k) {
      shifted = shifted + x;
      sum = sum + SquareRoot(shifted);
    }
    VLanes::Store(sum, to + i);
  }
}

}  // namespace ricochet::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace ricochet::bench {

HWY_EXPORT(Run);

void DivisionsAndRoots(int divisions, int roots, size_t count, const double* from, double* to) {
  HWY_DYNAMIC_DISPATCH(Run)(divisions, roots, count, from, to);
}

}  // namespace ricochet::bench

#endif  // HWY_ONCE
