#include "core/base/invariant.h"

#include <cstdio>
#include <cstdlib>

namespace ricochet {

void StopOnBrokenInvariant(const char* message, const char* file, int line) {
  std::fprintf(stderr, "ricochet: broken invariant at %s:%d: %s\n", file, line, message);
  std::abort();
}

}  // namespace ricochet
