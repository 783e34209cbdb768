// FakeSolver: a Solver with made answers, for tests of handlers.

#ifndef RICOCHET_TESTS_SERVER_FAKE_SOLVER_H_
#define RICOCHET_TESTS_SERVER_FAKE_SOLVER_H_

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <thread>
#include <vector>

#include "ricochet/solver.h"

namespace ricochet::server {

// Works until its options end the call.
inline absl::Status WorkUntilEnded(const CallOptions& options) {
  while (!options.stop.stop_requested() && !options.is_stopped()) {
    if (options.deadline.has_value() && std::chrono::steady_clock::now() >= *options.deadline) {
      return absl::DeadlineExceededError("the call's deadline has passed");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return absl::CancelledError("the call was stopped by its caller");
}

// Answers a plan at once, refuses audits, never ends bounds, and sweeps one point a chunk for ever.
class FakeSolver final : public Solver {
 public:
  mutable std::optional<std::chrono::steady_clock::time_point> deadline;
  size_t values = 1;        // Values in a chunk.
  int64_t most_chunks = 2;  // A sweep works on after so many chunks, but sends none.

 private:
  absl::StatusOr<SolveResponse> DoSolve(const SolveRequest& /*request*/, const CallOptions& options) const override {
    deadline = options.deadline;
    SolveResponse response;
    response.outcome.w_rank = 2;
    response.engine = {"1.2.3", "0123456789abcdef"};
    return response;
  }
  absl::StatusOr<PlanResponse> DoPlan(const PlanRequest& request, const CallOptions& /*options*/) const override {
    return PlanResponse{.plan = {.relative_tolerance = request.demand.relative_tolerance.value_or(0.0)}, .engine = {}};
  }
  absl::StatusOr<BoundsResponse> DoBounds(const BoundsRequest& /*request*/, const CallOptions& options) const override {
    return WorkUntilEnded(options);
  }
  absl::StatusOr<AuditResponse> DoAudit(const AuditRequest& /*request*/,
                                        const CallOptions& /*options*/) const override {
    return InvalidRequest({{"scene", "is refused"}});
  }
  absl::StatusOr<BatchResponse> DoSolveBatch(const BatchSetup& /*setup*/, const BatchRows& /*rows*/,
                                             const CallOptions& /*options*/) const override {
    return absl::UnimplementedError("fake");
  }
  absl::StatusOr<BatchSession> DoOpenBatches(const BatchSetup& /*setup*/,
                                             const CallOptions& /*options*/) const override {
    return absl::UnimplementedError("fake");
  }
  absl::StatusOr<AuditBatchResponse> DoAuditBatch(const AuditBatchRequest& /*request*/,
                                                  const CallOptions& /*options*/) const override {
    return InvalidRequest({{"scene", "is refused"}});
  }
  absl::StatusOr<FitResponse> DoFit(const FitRequest& /*request*/, const CallOptions& options) const override {
    return WorkUntilEnded(options);
  }
  absl::StatusOr<MultiContactResponse> DoMultiContact(const MultiContactRequest& /*request*/,
                                                      const CallOptions& /*options*/) const override {
    return absl::UnimplementedError("fake");
  }
  SweepStream DoSweep(const SweepRequest& request, const CallOptions& options) const override {
    return SweepStream(
        [options, next = int64_t{0}, count = values, chunks = most_chunks,
         total = request.end_index.value_or(1'000'000)]() mutable -> std::optional<absl::StatusOr<SweepChunk>> {
          if (next == chunks) return WorkUntilEnded(options);
          SweepChunk chunk = {.first_index = next, .count = 1, .values = std::vector<double>(count), .regimes = {}};
          chunk.points_done = ++next;
          chunk.points_total = total;
          return chunk;
        });
  }
  absl::StatusOr<InfoResponse> DoInfo(const InfoRequest& /*request*/, const CallOptions& /*options*/) const override {
    return InfoResponse{.limits = {.max_links = 7}, .systems = {"pendulum"}};
  }
  CostStream DoCost(const CostRequest& /*request*/, const CallOptions& options) const override {
    return CostStream([options, next = int64_t{0}]() mutable -> std::optional<absl::StatusOr<CostChunk>> {
      if (next == 2) return WorkUntilEnded(options);
      CostChunk chunk = {.first_row = next, .rows = {{.name = "row"}}, .rows_total = 9};
      chunk.rows_done = ++next;
      return chunk;
    });
  }
};

}  // namespace ricochet::server

#endif  // RICOCHET_TESTS_SERVER_FAKE_SOLVER_H_
