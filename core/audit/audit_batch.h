// AuditRows: the rows of a batch of audits, each of them by itself, as AuditScene (core/audit/audit_scene.h) audits one
// impact.

#ifndef RICOCHET_CORE_AUDIT_AUDIT_BATCH_H_
#define RICOCHET_CORE_AUDIT_AUDIT_BATCH_H_

#include <cstddef>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "core/audit/audit.h"
#include "core/contact/scene_contact.h"
#include "ricochet/audit.h"
#include "ricochet/scene.h"
#include "ricochet/solver.h"

namespace ricochet {

// Thread safety: several threads may audit rows at once.
class AuditRows {
 public:
  // The columns of the request must outlive this object.
  // Errors: INVALID_ARGUMENT with every violation of the scene and the columns; the error of a contact that exceeds the
  // range of doubles.
  static absl::StatusOr<AuditRows> Make(const AuditBatchRequest& request);

  size_t size() const { return size_; }

  // A row that breaks a rule or whose report overflows is reported as kInvalid.
  // Errors: CANCELLED once `stopped` returns true.
  absl::StatusOr<AuditReport> Audit(size_t row, absl::FunctionRef<bool()> stopped) const;

 private:
  AuditRows(const AuditColumns& columns, size_t size, Scene scene, const SceneContact& contact);

  audit::AnyProblem ProblemAt(size_t row) const;
  void SetVelocity(size_t row, pendulum::Problem& problem) const;
  void SetVelocity(size_t row, planar::Problem& problem) const;
  void SetVelocity(size_t row, spatial::Problem& problem) const;
  void SetFriction(size_t row, double& mu, double& mu_static) const;
  std::vector<double> RatesAt(size_t row) const;
  audit::Observation ObservationAt(size_t row) const;

  const AuditColumns& columns_;
  size_t size_;
  Scene scene_;
  AnyReduction reduction_;
  audit::AnyProblem scene_problem_;  // From the scene's own velocity.
};

// Counts reports, row after row.
AuditSummary Summarize(const std::vector<AuditReport>& reports);

}  // namespace ricochet

#endif  // RICOCHET_CORE_AUDIT_AUDIT_BATCH_H_
