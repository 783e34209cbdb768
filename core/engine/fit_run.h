// RunFit: a fit (core/fit/fit.h) whose rows are solved by the thread that asks and by others that help.

#ifndef RICOCHET_CORE_ENGINE_FIT_RUN_H_
#define RICOCHET_CORE_ENGINE_FIT_RUN_H_

#include <memory>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "ricochet/fit.h"
#include "ricochet/helpers.h"

namespace ricochet {

// Null stands for no helpers. `stopped` is asked on this thread alone: before each row, and every millisecond in which
// it waits for helpers. The engine is left to the caller. Errors: those of FitScene.
absl::StatusOr<FitResponse> RunFit(const FitRequest& request, std::shared_ptr<Helpers> helpers,
                                   absl::FunctionRef<bool()> stopped);

}  // namespace ricochet

#endif  // RICOCHET_CORE_ENGINE_FIT_RUN_H_
