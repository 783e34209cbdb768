// LocalSolver: the Solver that runs in this process. The embedded default; no server needed.

#ifndef RICOCHET_CORE_LOCAL_SOLVER_H_
#define RICOCHET_CORE_LOCAL_SOLVER_H_

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

}  // namespace ricochet

#endif  // RICOCHET_CORE_LOCAL_SOLVER_H_
