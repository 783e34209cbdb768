// OnlyTarget: dispatches to one SIMD target, to test that all targets give the same bits.

#ifndef RICOCHET_TESTS_SUPPORT_ONLY_TARGET_H_
#define RICOCHET_TESTS_SUPPORT_ONLY_TARGET_H_

#include <cstdint>

#include "hwy/targets.h"

namespace ricochet {

// Restricts dispatch to one target for its lifetime.
class OnlyTarget {
 public:
  explicit OnlyTarget(int64_t target) { Set(target); }
  OnlyTarget(const OnlyTarget&) = delete;
  OnlyTarget& operator=(const OnlyTarget&) = delete;
  ~OnlyTarget() { Set(0); }

 private:
  static void Set(int64_t targets) {
    hwy::SetSupportedTargetsForTest(targets);
    hwy::GetChosenTarget().DeInit();  // The next dispatch chooses anew.
  }
};

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_ONLY_TARGET_H_
