#include "core/local_solver.h"

#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "core/error.h"
#include "core/models/scene_bounds.h"
#include "core/models/scene_enclosure.h"
#include "core/models/scene_outcome.h"
#include "core/numerics/decimal.h"
#include "core/scene/validate.h"
#include "core/study/audit_scene.h"
#include "core/sweep/sweep_run.h"

namespace ricochet {
namespace {

absl::Status Inadmissible(const Outcome& outcome) {
  std::string message = "the outcome is inadmissible:";
  for (const BrokenLimit& limit : outcome.broken_limits) {
    message += limit.kind == LimitKind::kSharp
                   ? " its energetic coefficient " + ShortestDecimal(limit.value) + " exceeds 1;"
                   : " it creates " + ShortestDecimal(limit.value) + " J of kinetic energy;";
  }
  message.pop_back();
  return MakeError(absl::StatusCode::kFailedPrecondition, ErrorReason::kInadmissibleOutcome, message);
}

}  // namespace

absl::StatusOr<SolveResponse> LocalSolver::Solve(const SolveRequest& request) const {
  auto violations = Validate(request.scene);
  const double tolerance = request.demand.relative_tolerance.value_or(kDefaultTolerance);
  if (!(tolerance >= 0.0 && tolerance <= kMostTolerance)) {
    violations.push_back(MakeViolation("relative_tolerance", tolerance, "be in [0, 0.1]"));
  }
  if (!violations.empty()) return InvalidRequest(violations);
  absl::StatusOr<Outcome> outcome =
      SolveScene(request.scene, {.history_at_n_s = request.history_at_n_s, .tolerance = tolerance});
  if (!outcome.ok()) return outcome.status();
  if (request.inadmissible_is_error && !outcome->admissible) return Inadmissible(*outcome);
  return SolveResponse{.outcome = *std::move(outcome), .engine = ThisEngine()};
}

absl::StatusOr<BoundsResponse> LocalSolver::Bounds(const BoundsRequest& request) const {
  return AnswerBounds(request, [] { return false; });
}

absl::StatusOr<BoundsResponse> AnswerBounds(const BoundsRequest& request, absl::FunctionRef<bool()> stopped) {
  auto violations = Validate(request.scene, RestitutionIs::kOptional);
  if (!std::holds_alternative<std::monostate>(request.scene.impact_law)) {
    violations.push_back({"impact_law", "is set: must not be, for bounds"});
  }
  for (Violation& violation : CheckRanges(request.scene, request.ranges)) violations.push_back(std::move(violation));
  if (!violations.empty()) return InvalidRequest(violations);
  const absl::StatusOr<ricochet::Bounds> bounds = SolveSceneBounds(request.scene);
  if (!bounds.ok()) return bounds.status();
  BoundsResponse response{.bounds = *bounds, .engine = ThisEngine(), .enclosure = std::nullopt};
  if (request.ranges.empty()) return response;
  const absl::StatusOr<Enclosure> enclosure = EncloseScene(request.scene, request.ranges, stopped);
  if (!enclosure.ok()) return enclosure.status();
  response.enclosure = *enclosure;
  return response;
}

absl::StatusOr<AuditResponse> LocalSolver::Audit(const AuditRequest& request) const {
  absl::StatusOr<AuditResponse> response = AuditScene(request);
  if (response.ok()) response->engine = ThisEngine();
  return response;
}

absl::StatusOr<AuditBatchResponse> LocalSolver::AuditBatch(const AuditBatchRequest& request) const {
  absl::StatusOr<AuditBatchResponse> response = AuditScene(request);
  if (response.ok()) response->engine = ThisEngine();
  return response;
}

SweepStream LocalSolver::Sweep(const SweepRequest& request, std::stop_token stop) const {
  absl::StatusOr<SweepRun> made = SweepRun::Make(request);
  if (!made.ok()) return SweepStream(made.status());
  auto next = [run = *std::move(made), stop = std::move(stop), with_regime = request.with_regime,
               summary_sent = false]() mutable -> std::optional<absl::StatusOr<SweepChunk>> {
    if (summary_sent) return std::nullopt;
    const SweepRun::Extent extent = run.Next();
    SweepChunk chunk = {.first_index = extent.first_index, .count = extent.count};
    chunk.values.resize(static_cast<size_t>(extent.count * run.column_count()));
    if (with_regime) chunk.regimes.resize(static_cast<size_t>(extent.count));
    if (!run.Compute(extent, absl::MakeSpan(chunk.values), absl::MakeSpan(chunk.regimes),
                     [&stop] { return stop.stop_requested(); })) {
      return absl::CancelledError("the sweep was stopped by its caller");
    }
    chunk.points_done = run.points_done();
    chunk.points_total = run.points_total();
    chunk.engine = ThisEngine();
    summary_sent = run.done();
    if (run.done()) chunk.summary = run.summary();
    return chunk;
  };
  return SweepStream(std::move(next));
}

}  // namespace ricochet
