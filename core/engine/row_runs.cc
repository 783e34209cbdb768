#include "core/engine/row_runs.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "absl/status/status.h"
#include "core/audit/audit_batch.h"
#include "core/engine/parallel_batch.h"
#include "core/engine/piece_run.h"
#include "core/fit/fit.h"

namespace ricochet {

// Rows that a thread takes at once. Each takes some microseconds, and up to a millisecond in space.
static constexpr size_t kPiece = 16;

absl::StatusOr<AuditBatchResponse> RunAudits(const AuditBatchRequest& request, std::shared_ptr<Helpers> helpers,
                                             absl::FunctionRef<bool()> stopped) {
  const absl::StatusOr<AuditRows> rows = AuditRows::Make(request);
  if (!rows.ok()) return rows.status();
  AuditBatchResponse response;
  response.reports.resize(rows->size());
  const auto make_work = [&] {
    auto own = std::make_unique<audit::InputScene>(request.scene, request.inputs);
    return [&, own = std::move(own)](size_t piece, absl::FunctionRef<bool()> is_stopped) {
      const size_t end = std::min((piece + 1) * kPiece, rows->size());
      for (size_t row = piece * kPiece; row < end; ++row) {
        if (is_stopped()) return false;
        const absl::StatusOr<AuditReport> report = rows->Audit(row, *own, is_stopped);
        if (!report.ok()) return false;
        response.reports[row] = *report;
      }
      return true;
    };
  };
  PieceRun run((rows->size() + kPiece - 1) / kPiece, std::move(helpers), make_work);
  if (!run.Run(make_work(), stopped)) return absl::CancelledError("the audit was stopped by its caller");
  response.summary = Summarize(response.reports);
  return response;
}

absl::StatusOr<FitResponse> RunFit(const FitRequest& request, std::shared_ptr<Helpers> helpers,
                                   absl::FunctionRef<bool()> stopped) {
  const auto open_rows = [&helpers](CheckedBatch batch) -> fit::SolveRows {
    return [rows = std::make_unique<ParallelBatch>(std::move(batch), helpers)](
               const BatchRows& all, absl::FunctionRef<bool()> is_stopped) { return rows->Solve(all, is_stopped); };
  };
  return FitScene(request, open_rows, stopped);
}

}  // namespace ricochet
