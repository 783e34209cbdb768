// AuditScene: audits of observed impacts of any scene, one impact or a batch (core/study/audit.h).
//
// The scene is reduced to its contact (core/contact/reduction.h); a pendulum that strikes a surface at rest from the
// scene's own state goes by its closed form. Friction is the scene's at the approach speed; the restitution and the
// impact law are not used. A spatial path is integrated to spatial::kStudyTolerance.

#ifndef RICOCHET_CORE_STUDY_AUDIT_SCENE_H_
#define RICOCHET_CORE_STUDY_AUDIT_SCENE_H_

#include <cstdint>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "ricochet/solver.h"

namespace ricochet {

// Audits one impact, or each row of a batch. `stopped` is asked before each row, and before each solution of a row that
// takes many.
// Errors: INVALID_ARGUMENT with every violation; OUT_OF_RANGE if W, the velocities or the report of a single impact
// exceed the largest double; CANCELLED once `stopped` returns true. A bad row of a batch is no error: its report is
// kInvalid. The engine is left to the caller.
absl::StatusOr<AuditResponse> AuditScene(const AuditRequest& request, absl::FunctionRef<bool()> stopped);
absl::StatusOr<AuditBatchResponse> AuditScene(const AuditBatchRequest& request, absl::FunctionRef<bool()> stopped);

namespace audit {

// Counts the report of a row in the summary.
void Add(int64_t row, const AuditReport& report, AuditSummary& summary);

}  // namespace audit
}  // namespace ricochet

#endif  // RICOCHET_CORE_STUDY_AUDIT_SCENE_H_
