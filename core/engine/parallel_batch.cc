#include "core/engine/parallel_batch.h"

#include <cstdint>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "core/engine/piece_run.h"
#include "core/rows/row_source.h"
#include "core/types/check_rows.h"

namespace ricochet {
namespace {

absl::Status Stopped() { return absl::CancelledError("the batch was stopped by its caller"); }

bool Never() { return false; }

// Solves the rows [first, first + count). Returns false if it was stopped.
bool SolvePart(const BatchRows& rows, size_t first, size_t count, RowSolver& solver, BatchSummary& summary,
               absl::FunctionRef<bool()> stopped) {
  RowSink sink = {
      .columns = {}, .regimes = {}, .statuses = {}, .counts = summary.counts, .bad_rows = &summary.bad_rows};
  for (const absl::Span<double> column : rows.outputs) sink.columns.push_back(column.data() + first);
  if (!rows.regimes.empty()) sink.regimes = rows.regimes.subspan(first, count);
  if (!rows.statuses.empty()) sink.statuses = rows.statuses.subspan(first, count);
  ArrayRows source(rows.inputs);
  return solver.Solve(source, static_cast<int64_t>(first), static_cast<int64_t>(count), sink, stopped, Never)
      .has_value();
}

}  // namespace

ParallelBatch::ParallelBatch(CheckedBatch batch, std::shared_ptr<Helpers> helpers)
    : batch_(std::move(batch)),
      helpers_(std::move(helpers)),
      solvers_(
          [this] { return std::make_unique<RowSolver>(batch_.scene, batch_.fields, batch_.columns, batch_.demand); }),
      own_(solvers_.Take()) {}

absl::StatusOr<std::unique_ptr<ParallelBatch>> ParallelBatch::Make(const BatchSetup& setup,
                                                                   std::shared_ptr<Helpers> helpers) {
  absl::StatusOr<CheckedBatch> batch = CheckBatch(setup);
  if (!batch.ok()) return batch.status();
  return std::make_unique<ParallelBatch>(*std::move(batch), std::move(helpers));
}

// Returns how many rows a thread takes at once. Rows outside the lanes may take milliseconds each, so that many threads
// should find some of a few; four together still share the lanes of a contact in space.
size_t ParallelBatch::PieceOf(size_t rows) const {
  return own_->is_in_lanes() ? RowSolver::kBlock : std::clamp<size_t>(rows / 64, own_->is_in_space() ? 4 : 1, 64);
}

absl::StatusOr<BatchSummary> ParallelBatch::Solve(const BatchRows& rows, absl::FunctionRef<bool()> stopped) {
  const absl::Status misfit = CheckRows(rows, batch_.fields.size(), batch_.columns.size());
  if (!misfit.ok()) return misfit;
  const size_t all = RowCount(rows);
  const size_t size = PieceOf(all);
  if (all <= size) {
    BatchSummary summary;
    if (!SolvePart(rows, 0, all, *own_, summary, stopped)) return Stopped();
    return summary;
  }
  std::vector<BatchSummary> summaries((all + size - 1) / size);
  const auto solve_piece = [&](size_t piece, RowSolver& solver, absl::FunctionRef<bool()> is_stopped) {
    const size_t first = piece * size;
    return SolvePart(rows, first, std::min(size, all - first), solver, summaries[piece], is_stopped);
  };
  const auto make_work = [&] {
    return [&, solver = solvers_.Take()](size_t piece, absl::FunctionRef<bool()> is_stopped) {
      return solve_piece(piece, *solver, is_stopped);
    };
  };
  PieceRun run(summaries.size(), helpers_, make_work);
  const auto own_work = [&](size_t piece, absl::FunctionRef<bool()> is_stopped) {
    return solve_piece(piece, *own_, is_stopped);
  };
  if (!run.Run(own_work, stopped)) return Stopped();
  BatchSummary whole;
  for (BatchSummary& summary : summaries) whole = Joined(std::move(whole), std::move(summary), 0);
  return whole;
}

}  // namespace ricochet
