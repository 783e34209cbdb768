// Stands for the model of finite duration in a build without SUNDIALS. A request for it is refused before a Solve.

#include "core/base/invariant.h"
#include "core/models/finite_duration/finite_duration.h"

namespace ricochet::finite_duration {

const char* WhyUnavailable() { return "this build has no impacts that take time"; }

Impact Solve(const Problem& /*problem*/, absl::FunctionRef<bool()> /*stopped*/) {
  StopOnBrokenInvariant("this build has no model of finite duration", __FILE__, __LINE__);
}

double LibraryPower(double /*base*/, double /*exponent*/) {
  StopOnBrokenInvariant("this build has no model of finite duration", __FILE__, __LINE__);
}

}  // namespace ricochet::finite_duration
