#include <algorithm>
#include <chrono>
#include <cstddef>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/answer/bounds_derivatives.h"
#include "core/answer/derivatives.h"
#include "core/answer/scene_bounds.h"
#include "core/answer/scene_enclosure.h"
#include "core/answer/scene_outcome.h"
#include "core/audit/audit_scene.h"
#include "core/base/decimal.h"
#include "core/base/floating_point_mode.h"
#include "core/base/invariant.h"
#include "core/certified/certified.h"
#include "core/cost/cost.h"
#include "core/engine/call_control.h"
#include "core/engine/check_limits.h"
#include "core/engine/check_solve.h"
#include "core/engine/chunk_size.h"
#include "core/engine/helper_threads.h"
#include "core/engine/parallel_batch.h"
#include "core/engine/row_runs.h"
#include "core/engine/sweep_run.h"
#include "core/multi/solve_multi_contact.h"
#include "core/plan/demand.h"
#include "core/scene/validate.h"
#include "core/scene/validate_multi.h"
#include "core/types/check_rows.h"
#include "ricochet/engine_info.h"
#include "ricochet/error.h"
#include "ricochet/solver.h"

namespace ricochet {
namespace {

std::string BrokenLimitText(const BrokenLimit& limit) {
  const std::string value = ShortestDecimal(limit.value);
  switch (limit.kind) {
    case LimitKind::kSharp:
      return " its energetic coefficient " + value + " exceeds 1;";
    case LimitKind::kEnergy:
      return " it creates " + value + " J of kinetic energy;";
    case LimitKind::kFriction:
      return " its friction does " + value + " J of work along the slip;";
    case LimitKind::kUnspecified:
      break;
  }
  return " of an unknown limit;";
}

// Gives FAILED_PRECONDITION if the end, an Outcome or a FreeEnd, breaks limits, which are then named, or if it is not
// the end of the impact. `where` says which end it is.
template <typename End>
absl::Status CheckAdmissible(const End& end, absl::string_view where) {
  std::string message;
  if (end.regime == Regime::kNoSolution) {
    message = absl::StrCat("the impact law has no solution for this contact", where);
  } else if (end.termination == Termination::kBudgetUsedUp) {
    message = absl::StrCat("the model's budget of steps ran out before the contact separated", where);
  } else if (end.termination == Termination::kRefused) {
    message = absl::StrCat("the contact has no end that is known", where);
  } else if (!end.admissible) {
    message = absl::StrCat("the outcome", where, " is inadmissible:");
    for (const BrokenLimit& limit : end.broken_limits) message += BrokenLimitText(limit);
    message.pop_back();
  } else {
    return absl::OkStatus();
  }
  return MakeError(absl::StatusCode::kFailedPrecondition, ErrorReason::kInadmissibleOutcome, message);
}

absl::Status CheckAdmissible(const Outcome& outcome) {
  absl::Status status = CheckAdmissible(outcome, "");
  if (!status.ok() || !outcome.free_end.has_value()) return status;
  return CheckAdmissible(*outcome.free_end, " with no coordinate held");
}

// These times let a client see its first points soon, and keep the wait between two chunks short.
constexpr std::chrono::milliseconds kFirstChunkTime(100);
constexpr std::chrono::milliseconds kChunkTime(1000);

// Sets `certificate` to what `certify` proves, if the request asks for digits.
template <typename Request, typename CertifyScene>
absl::Status Certify(const Request& request, const CertifyScene& certify, absl::FunctionRef<bool()> stopped,
                     std::optional<Certificate>& certificate) {
  if (request.certified_digits == 0) return absl::OkStatus();
  absl::StatusOr<Certificate> certified =
      certify(request.scene, CertifiedPrecision{.digits = request.certified_digits}, stopped);
  if (!certified.ok()) return certified.status();
  certificate = *std::move(certified);
  return absl::OkStatus();
}

// Answers in place, because an outcome is large.
absl::Status Answer(const SolveRequest& request, CallControl& control, SolveResponse& response) {
  std::optional<SceneContact> contact;
  std::vector<Violation> of_scene = Validate(request.scene, RestitutionIs::kRequired, contact);
  if (!of_scene.empty()) {
    for (Violation& violation : CheckSolve(request)) of_scene.push_back(std::move(violation));
    return InvalidRequest(of_scene);
  }
  const std::vector<Violation> of_request = CheckSolve(request, contact);
  if (!of_request.empty()) return InvalidRequest(of_request);
  if (absl::Status ended = control.WhyEnded(); !ended.ok()) return ended;
  const auto stopped = [&control] { return control.IsStopped(); };
  Outcome& outcome = response.outcome;
  const OutcomeDetail detail = {.history_at_n_s = request.history_at_n_s,
                                .history_intervals = request.history_intervals,
                                .force_intervals = request.force_intervals};
  const absl::Status solved = SolveScene(request.scene, contact, DemandOf(request), detail, stopped, outcome);
  if (!solved.ok()) return control.OrWhyEnded(solved);
  if (request.both_ends) {
    const absl::Status ended = SetFreeEnd(request.scene, DemandOf(request), stopped, outcome);
    if (!ended.ok()) return control.OrWhyEnded(ended);
  }
  if (request.inadmissible_is_error) {
    if (absl::Status status = CheckAdmissible(outcome); !status.ok()) return status;
  }
  const absl::Status certified = Certify(request, CertifySolve, stopped, outcome.certificate);
  if (!certified.ok()) return control.OrWhyEnded(certified);
  if (request.derivatives.has_value()) {
    auto derivatives = DerivativesOf(request.scene, DemandOf(request), *request.derivatives, stopped);
    if (!derivatives.ok()) return control.OrWhyEnded(derivatives.status());
    outcome.derivatives = *std::move(derivatives);
  }
  response.engine = ThisEngine();
  return absl::OkStatus();
}

// Answers by `compute`, which checks the request but for its size.
template <typename Response, typename Request, typename Compute>
absl::StatusOr<Response> Answered(const Request& request, const Limits& limits, const CallOptions& options,
                                  const Compute& compute) {
  const DefaultFloatingPoint mode;
  CallControl control(options);
  if (absl::Status too_large = CheckLimits(request, limits); !too_large.ok()) return too_large;
  if (absl::Status ended = control.WhyEnded(); !ended.ok()) return ended;
  const auto stopped = [&control] { return control.IsStopped(); };
  absl::StatusOr<Response> response = compute(request, absl::FunctionRef<bool()>(stopped));
  if (!response.ok()) return control.OrWhyEnded(response.status());
  response->engine = ThisEngine();
  return response;
}

}  // namespace

LocalSolver::LocalSolver(const Limits& limits, int threads)
    : limits_(limits), helpers_(threads > 1 ? std::make_shared<HelperThreads>(threads - 1) : nullptr) {
  CheckInvariant(threads >= 1, "a LocalSolver has at least one thread");
}

absl::StatusOr<SolveResponse> LocalSolver::DoSolve(const SolveRequest& request, const CallOptions& options) const {
  const DefaultFloatingPoint mode;
  CallControl control(options);
  // The only return names the response, so that a large answer is made in the place of the caller's.
  absl::StatusOr<SolveResponse> response(absl::in_place);
  absl::Status status = CheckLimits(request, limits_);
  if (status.ok()) status = Answer(request, control, *response);
  if (!status.ok()) response = std::move(status);
  return response;
}

absl::StatusOr<PlanResponse> LocalSolver::DoPlan(const PlanRequest& request, const CallOptions& options) const {
  const DefaultFloatingPoint mode;
  CallControl control(options);
  if (absl::Status too_large = CheckLimits(request, limits_); !too_large.ok()) return too_large;
  std::optional<SceneContact> contact;
  std::vector<Violation> violations = Validate(request.scene, RestitutionIs::kRequired, contact);
  std::vector<Violation> of_demand =
      violations.empty() ? CheckDemand(request.scene, contact, request.demand) : CheckDemand(request.demand);
  std::move(of_demand.begin(), of_demand.end(), std::back_inserter(violations));
  if (!violations.empty()) return InvalidRequest(violations);
  if (absl::Status ended = control.WhyEnded(); !ended.ok()) return ended;
  absl::StatusOr<ricochet::Plan> plan = PlanOf(request.scene, contact, ToDemand(request.demand));
  if (!plan.ok()) return plan.status();
  return PlanResponse{.plan = *std::move(plan), .engine = ThisEngine()};
}

absl::StatusOr<BoundsResponse> LocalSolver::DoBounds(const BoundsRequest& request, const CallOptions& options) const {
  const DefaultFloatingPoint mode;
  CallControl control(options);
  if (absl::Status too_large = CheckLimits(request, limits_); !too_large.ok()) return too_large;
  const auto stopped = [&control] { return control.IsStopped(); };
  std::optional<SceneContact> contact;
  auto violations = Validate(request.scene, RestitutionIs::kOptional, contact);
  if (!std::holds_alternative<std::monostate>(request.scene.impact_law)) {
    violations.push_back(MakeViolation("impact_law", "is set", "not be, for bounds"));
  }
  if (violations.empty()) RequireRigid(request.scene, RigidIn::kBothDirections, "for bounds", violations);
  for (Violation& violation : CheckRanges(request.scene, request.ranges)) violations.push_back(std::move(violation));
  CheckDigits(request.scene, request.certified_digits, violations);
  if (violations.empty() && request.derivatives.has_value()) {
    violations = CheckBoundsDerivatives(request.scene, *request.derivatives);
  }
  if (!violations.empty()) return InvalidRequest(violations);
  if (absl::Status ended = control.WhyEnded(); !ended.ok()) return ended;
  const absl::StatusOr<ricochet::Bounds> bounds = SolveSceneBounds(request.scene, std::move(contact), stopped);
  if (!bounds.ok()) return control.OrWhyEnded(bounds.status());
  BoundsResponse response{.bounds = *bounds, .engine = ThisEngine()};
  const absl::Status certified = Certify(request, CertifyBounds, stopped, response.certificate);
  if (!certified.ok()) return control.OrWhyEnded(certified);
  if (request.derivatives.has_value()) {
    auto derivatives = BoundsDerivativesOf(request.scene, *bounds, *request.derivatives, stopped);
    if (!derivatives.ok()) return control.OrWhyEnded(derivatives.status());
    response.derivatives = *std::move(derivatives);
  }
  if (request.ranges.empty()) return response;
  const absl::StatusOr<Enclosure> enclosure = EncloseScene(request.scene, request.ranges, limits_.max_boxes, stopped);
  if (!enclosure.ok()) return control.OrWhyEnded(enclosure.status());
  response.enclosure = *enclosure;
  return response;
}

absl::StatusOr<AuditResponse> LocalSolver::DoAudit(const AuditRequest& request, const CallOptions& options) const {
  return Answered<AuditResponse>(request, limits_, options, AuditScene);
}

absl::StatusOr<AuditBatchResponse> LocalSolver::DoAuditBatch(const AuditBatchRequest& request,
                                                             const CallOptions& options) const {
  return Answered<AuditBatchResponse>(request, limits_, options, [&](const auto& valid, auto stopped) {
    return RunAudits(valid, HelpersOf(options), stopped);
  });
}

absl::StatusOr<FitResponse> LocalSolver::DoFit(const FitRequest& request, const CallOptions& options) const {
  return Answered<FitResponse>(request, limits_, options, [&](const auto& valid, auto stopped) {
    return RunFit(valid, HelpersOf(options), stopped);
  });
}

absl::StatusOr<MultiContactResponse> LocalSolver::DoMultiContact(const MultiContactRequest& request,
                                                                 const CallOptions& options) const {
  const DefaultFloatingPoint mode;
  CallControl watch(options);
  if (absl::Status too_large = CheckLimits(request, limits_); !too_large.ok()) return too_large;
  std::optional<MultiReduction> reduction;
  const std::vector<Violation> violations = Validate(request, reduction);
  if (!violations.empty()) return InvalidRequest(violations);
  if (absl::Status ended = watch.WhyEnded(); !ended.ok()) return ended;
  absl::StatusOr<std::vector<MultiContactAnswer>> answers =
      SolveMultiContact(request, *reduction, [&watch] { return watch.IsStopped(); });
  if (!answers.ok()) return watch.OrWhyEnded(answers.status());
  return MultiContactResponse{.answers = *std::move(answers), .engine = ThisEngine()};
}

namespace {

class LocalBatches final : public BatchSession::Worker {
 public:
  LocalBatches(std::unique_ptr<ParallelBatch> run, const Limits& limits, const CallOptions& options)
      : run_(std::move(run)), limits_(limits), control_(options) {}

  absl::Status CheckSize(size_t rows) const override { return CheckBatchSize(rows, run_->columns(), limits_); }

  absl::StatusOr<BatchSummary> Solve(const BatchRows& rows) override {
    const DefaultFloatingPoint mode;
    if (absl::Status too_large = CheckSize(RowCount(rows)); !too_large.ok()) return too_large;
    if (absl::Status ended = control_.WhyEnded(); !ended.ok()) return ended;
    absl::StatusOr<BatchSummary> summary = run_->Solve(rows, [this] { return control_.IsStopped(); });
    if (!summary.ok()) return control_.OrWhyEnded(summary.status());
    return summary;
  }
  const EngineInfo& engine() const override { return ThisEngine(); }

 private:
  std::unique_ptr<ParallelBatch> run_;
  const Limits limits_;
  CallControl control_;
};

}  // namespace

absl::StatusOr<BatchSession> LocalSolver::DoOpenBatches(const BatchSetup& setup, const CallOptions& options) const {
  const DefaultFloatingPoint mode;
  if (absl::Status too_large = CheckLimits(setup, limits_); !too_large.ok()) return too_large;
  absl::StatusOr<std::unique_ptr<ParallelBatch>> run = ParallelBatch::Make(setup, HelpersOf(options));
  if (!run.ok()) return run.status();
  return BatchSession(std::make_unique<LocalBatches>(*std::move(run), limits_, options));
}

absl::StatusOr<BatchResponse> LocalSolver::DoSolveBatch(const BatchSetup& setup, const BatchRows& rows,
                                                        const CallOptions& options) const {
  absl::StatusOr<BatchSession> session = DoOpenBatches(setup, options);
  if (!session.ok()) return session.status();
  absl::StatusOr<BatchSummary> summary = session->Solve(rows);
  if (!summary.ok()) return summary.status();
  return BatchResponse{.summary = *std::move(summary), .engine = session->engine()};
}

SweepStream LocalSolver::DoSweep(const SweepRequest& request, const CallOptions& options) const {
  const DefaultFloatingPoint mode;
  if (absl::Status too_large = CheckLimits(request, limits_); !too_large.ok()) return SweepStream(too_large);
  absl::StatusOr<SweepRun> made = SweepRun::Make(request, HelpersOf(options));
  if (!made.ok()) return SweepStream(made.status());
  if (absl::Status too_large = CheckPoints(made->points_total(), limits_); !too_large.ok()) {
    return SweepStream(too_large);
  }
  auto next = [run = *std::move(made), control = CallControl(options), size = ChunkSize(),
               is_first = true]() mutable -> std::optional<absl::StatusOr<SweepChunk>> {
    if (run.ended()) return std::nullopt;
    const DefaultFloatingPoint mode_of_part;
    control.StartPiece(std::exchange(is_first, false) ? kFirstChunkTime : kChunkTime);
    const int64_t most_bytes = size.Next(std::chrono::steady_clock::now());
    absl::StatusOr<SweepChunk> chunk = run.NextChunk([&control] { return control.IsStopped(); },
                                                     [&control] { return control.PieceTookLongEnough(); }, most_bytes);
    if (!chunk.ok()) return control.OrWhyEnded(chunk.status());
    chunk->engine = ThisEngine();
    size.Emitted(std::chrono::steady_clock::now());
    return chunk;
  };
  return SweepStream(std::move(next));
}

CostStream LocalSolver::DoCost(const CostRequest& request, const CallOptions& options) const {
  const DefaultFloatingPoint mode;
  if (absl::Status too_large = CheckLimits(request, limits_); !too_large.ok()) return CostStream(too_large);
  absl::StatusOr<CostStudy> made = CostStudy::Make(request);
  if (!made.ok()) return CostStream(made.status());
  auto next = [study = *std::move(made),
               control = CallControl(options)]() mutable -> std::optional<absl::StatusOr<CostChunk>> {
    if (study.ended()) return std::nullopt;
    const DefaultFloatingPoint mode_of_part;
    absl::StatusOr<CostChunk> chunk = study.NextChunk([&control] { return control.IsStopped(); });
    if (!chunk.ok()) return control.OrWhyEnded(chunk.status());
    chunk->engine = ThisEngine();
    return chunk;
  };
  return CostStream(std::move(next));
}

absl::StatusOr<InfoResponse> LocalSolver::DoInfo(const InfoRequest& /*request*/, const CallOptions& options) const {
  // The names are in the order of System, whose first alternative stands for no system.
  static constexpr const char* kSystems[] = {"pendulum", "planar_body",    "spatial_body",    "body_pair",
                                             "linkage",  "planar_contact", "spatial_contact", "mechanism"};
  static_assert(std::size(kSystems) + 1 == std::variant_size_v<System>);
  if (absl::Status ended = CallControl(options).WhyEnded(); !ended.ok()) return ended;
  InfoResponse info = {.engine = ThisEngine(),
                       .limits = limits_,
                       .certified = certified::IsAvailable(),
                       .systems = {std::begin(kSystems), std::end(kSystems)}};
  for (int number = 1; number < kModelCount; ++number) info.models.push_back(static_cast<Model>(number));
  return info;
}

}  // namespace ricochet
