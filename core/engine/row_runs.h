// RunAudits and RunFit: calls whose rows are computed by the thread that asks and by others that help.

#ifndef RICOCHET_CORE_ENGINE_ROW_RUNS_H_
#define RICOCHET_CORE_ENGINE_ROW_RUNS_H_

#include <memory>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "ricochet/fit.h"
#include "ricochet/helpers.h"
#include "ricochet/solver.h"

namespace ricochet {

// Audits each row; the threads change no report and no count. Helpers are asked once a batch has lasted for a
// millisecond; null stands for none. `stopped` is asked on this thread alone: before each row that it audits, before
// each solution of a row that takes many, and every millisecond in which it waits for helpers. An exception that a
// helper meets is thrown here. The engine is left to the caller. Errors: those of AuditRows::Make, CANCELLED once
// `stopped` returns true. A bad row is no error: its report is kInvalid.
absl::StatusOr<AuditBatchResponse> RunAudits(const AuditBatchRequest& request, std::shared_ptr<Helpers> helpers,
                                             absl::FunctionRef<bool()> stopped);

// Fits a scene (core/fit/fit.h). Null stands for no helpers. `stopped` is asked on this thread alone: before each row,
// and every millisecond in which it waits for helpers. The engine is left to the caller. Errors: those of FitScene.
absl::StatusOr<FitResponse> RunFit(const FitRequest& request, std::shared_ptr<Helpers> helpers,
                                   absl::FunctionRef<bool()> stopped);

}  // namespace ricochet

#endif  // RICOCHET_CORE_ENGINE_ROW_RUNS_H_
