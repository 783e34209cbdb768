// AuditScene: the audit of any scene, reduced to its contact (core/contact/reduction.h), by core/study/audit.h.
//
// A pendulum that strikes a surface at rest from the scene's own state goes by its closed form. Friction is the scene's
// at the approach speed; the restitution and the impact law are not used. A spatial path is integrated to
// spatial::kStudyTolerance.

#ifndef RICOCHET_CORE_STUDY_AUDIT_SCENE_H_
#define RICOCHET_CORE_STUDY_AUDIT_SCENE_H_

#include "absl/status/statusor.h"
#include "ricochet/solver.h"

namespace ricochet {

// Errors: INVALID_ARGUMENT with every violation; OUT_OF_RANGE if W, the velocities or the report exceed the largest
// double. In a batch only what all rows share can be an error. The engine is left to the caller.
absl::StatusOr<AuditResponse> AuditScene(const AuditRequest& request);
absl::StatusOr<AuditBatchResponse> AuditScene(const AuditBatchRequest& request);

}  // namespace ricochet

#endif  // RICOCHET_CORE_STUDY_AUDIT_SCENE_H_
