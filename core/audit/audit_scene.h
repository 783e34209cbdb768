// AuditScene: the audit of an observed impact of any scene (core/audit/audit.h).
//
// The scene is reduced to its contact (core/contact/reduction.h); a pendulum that strikes a surface at rest from the
// scene's own state goes by its closed form. Friction is the scene's at the approach speed; the restitution and the
// impact law are not used. A spatial path is integrated to spatial::kStudyTolerance.

#ifndef RICOCHET_CORE_AUDIT_AUDIT_SCENE_H_
#define RICOCHET_CORE_AUDIT_AUDIT_SCENE_H_

#include <cstdint>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "ricochet/solver.h"

namespace ricochet {

// Audits one impact. `stopped` is asked before each solution of an audit that takes many.
// Errors: INVALID_ARGUMENT with every violation; OUT_OF_RANGE if W, the velocities or the report exceed the largest
// double, or the impact under friction takes too many steps; CANCELLED once `stopped` returns true. The engine is left
// to the caller.
absl::StatusOr<AuditResponse> AuditScene(const AuditRequest& request, absl::FunctionRef<bool()> stopped);

namespace audit {

// Counts the report of a row in the summary.
void Add(int64_t row, const AuditReport& report, AuditSummary& summary);

}  // namespace audit
}  // namespace ricochet

#endif  // RICOCHET_CORE_AUDIT_AUDIT_SCENE_H_
