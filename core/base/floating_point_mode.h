// DefaultFloatingPoint: while it lives, its thread computes as a C++ program starts: it rounds to nearest, keeps
// subnormal numbers and traps nothing. Then the mode of the caller is back.
//
// Bounds on errors and the equality of bits rely on that mode, and a caller may have changed it: a program that is
// linked with -ffast-math flushes subnormal numbers to 0, and after feenableexcept the division by 0 that a kernel
// makes on purpose would end the process. A new thread has the mode of the one that starts it.

#ifndef RICOCHET_CORE_BASE_FLOATING_POINT_MODE_H_
#define RICOCHET_CORE_BASE_FLOATING_POINT_MODE_H_

#include <cfenv>

#if defined(__x86_64__)
#include <xmmintrin.h>

#include <cstdint>
#endif

namespace ricochet {

class DefaultFloatingPoint {
 public:
  DefaultFloatingPoint() : is_changed_(!IsSet()) {
    if (!is_changed_) return;
    std::fegetenv(&of_caller_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~DefaultFloatingPoint() {
    if (is_changed_) std::fesetenv(&of_caller_);
  }
  DefaultFloatingPoint(const DefaultFloatingPoint&) = delete;
  DefaultFloatingPoint& operator=(const DefaultFloatingPoint&) = delete;

 private:
  // To look takes some nanoseconds, to set the mode a hundred.
  static bool IsSet() {
#if defined(__x86_64__)
    constexpr unsigned kRaised = 0x3f;  // The exceptions that have occurred.
    uint16_t x87 = 0;
    asm volatile("fnstcw %0" : "=m"(x87));
    return (_mm_getcsr() & ~kRaised) == 0x1f80 && x87 == 0x37f;
#else
    return false;
#endif
  }

  const bool is_changed_;
  std::fenv_t of_caller_;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_BASE_FLOATING_POINT_MODE_H_
