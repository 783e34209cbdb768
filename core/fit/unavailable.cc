// Takes the place of every other source of this folder in a build without Ceres: every fit is refused.

#include "core/fit/fit.h"
#include "ricochet/error.h"

namespace ricochet {

bool fit::IsAvailable() { return false; }

absl::StatusOr<FitResponse> FitScene(const FitRequest& /*request*/, absl::FunctionRef<bool()> /*stopped*/) {
  return InvalidRequest({MakeViolation("unknowns", "is set", "not be, this build has no fits (component fit)")});
}

}  // namespace ricochet
