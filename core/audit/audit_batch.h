// AuditRows: the rows of a batch of audits, each of them by itself, as AuditScene (core/audit/audit_scene.h) audits one
// impact.

#ifndef RICOCHET_CORE_AUDIT_AUDIT_BATCH_H_
#define RICOCHET_CORE_AUDIT_AUDIT_BATCH_H_

#include <cstddef>
#include <optional>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "core/audit/audit.h"
#include "core/audit/input_scene.h"
#include "core/contact/scene_contact.h"
#include "ricochet/audit.h"
#include "ricochet/scene.h"
#include "ricochet/solver.h"

namespace ricochet {

// Thread safety: several threads may audit rows at once, each with a scene of its own.
class AuditRows {
 public:
  // The request must outlive this object.
  // Errors: INVALID_ARGUMENT with every violation of scene, inputs and columns; without inputs the error of a contact
  // that exceeds the range of doubles.
  static absl::StatusOr<AuditRows> Make(const AuditBatchRequest& request);

  size_t size() const { return size_; }

  // A row that breaks a rule, whose report overflows or whose path takes too many steps is reported as kInvalid.
  // Errors: CANCELLED once `stopped` returns true.
  // `own` is a scene of the caller's thread, with the inputs of the request.
  absl::StatusOr<AuditReport> Audit(size_t row, audit::InputScene& own, absl::FunctionRef<bool()> stopped) const;

 private:
  // The impact that a row, or all rows, begin from.
  struct Impact {
    Impact(Scene its_scene, const SceneContact& contact, bool from_own_velocity);

    Scene scene;
    AnyReduction reduction;
    audit::AnyProblem problem;
    audit::Observation terms;  // It has the terms of the scene's own velocity, and none if the columns state another.
  };

  AuditRows(const AuditBatchRequest& request, size_t size) : columns_(request.columns), size_(size) {}

  // Nothing if the scene of the row breaks a rule or exceeds the range of doubles.
  std::optional<Impact> ImpactAt(size_t row, audit::InputScene& own) const;
  audit::AnyProblem ProblemAt(size_t row, const Impact& impact) const;
  void SetVelocity(size_t row, pendulum::Problem& problem) const;
  void SetVelocity(size_t row, planar::Problem& problem) const;
  void SetVelocity(size_t row, spatial::Problem& problem) const;
  void SetFriction(size_t row, const Scene& scene, double& mu, double& mu_static) const;
  std::vector<double> RatesAt(size_t row) const;
  audit::Observation ObservationAt(size_t row, absl::Span<const double> rates, const Impact& impact) const;

  const AuditColumns& columns_;
  size_t size_;
  std::optional<Impact> shared_;  // Unset beside inputs, by which each row has its own.
};

// Counts reports, row after row.
AuditSummary Summarize(const std::vector<AuditReport>& reports);

}  // namespace ricochet

#endif  // RICOCHET_CORE_AUDIT_AUDIT_BATCH_H_
