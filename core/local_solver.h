// LocalSolver: the Solver that runs in this process. The embedded default; no server needed.

#ifndef RICOCHET_CORE_LOCAL_SOLVER_H_
#define RICOCHET_CORE_LOCAL_SOLVER_H_

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "core/solver.h"

namespace ricochet {

class LocalSolver final : public Solver {
 public:
  using Solver::Sweep;
  absl::StatusOr<SolveResponse> Solve(const SolveRequest& request) const override;
  absl::StatusOr<BoundsResponse> Bounds(const BoundsRequest& request) const override;
  absl::StatusOr<AuditResponse> Audit(const AuditRequest& request) const override;
  absl::StatusOr<AuditBatchResponse> AuditBatch(const AuditBatchRequest& request) const override;
  SweepStream Sweep(const SweepRequest& request, std::stop_token stop) const override;
};

// LocalSolver::Bounds for a caller who may stop waiting: the search of an enclosure, which can take seconds, ends with
// CANCELLED soon after `stopped` says so (core/models/scene_enclosure.h).
absl::StatusOr<BoundsResponse> AnswerBounds(const BoundsRequest& request, absl::FunctionRef<bool()> stopped);

}  // namespace ricochet

#endif  // RICOCHET_CORE_LOCAL_SOLVER_H_
