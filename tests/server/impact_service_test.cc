// The handlers pass requests and options on to any Solver, and its answers and errors back.

#include "server/impact_service.h"

#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <fstream>
#include <limits>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "proto/wire/status.h"
#include "ricochet/error.h"

namespace ricochet::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

// Works until its options end the call.
absl::Status WorkUntilEnded(const CallOptions& options) {
  while (!options.stop.stop_requested() && !options.is_stopped()) std::this_thread::sleep_for(milliseconds(1));
  return absl::CancelledError("the call was stopped by its caller");
}

// Answers a plan at once, refuses audits, never ends bounds, and sweeps one point a chunk for ever.
class FakeSolver final : public Solver {
 public:
  mutable std::optional<steady_clock::time_point> deadline;

 private:
  absl::StatusOr<SolveResponse> DoSolve(const SolveRequest& /*request*/, const CallOptions& options) const override {
    deadline = options.deadline;
    return SolveResponse{.outcome = {.w_rank = 2}, .engine = {"1.2.3", "0123456789abcdef"}};
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
  absl::StatusOr<AuditBatchResponse> DoAuditBatch(const AuditBatchRequest& /*request*/,
                                                  const CallOptions& /*options*/) const override {
    return InvalidRequest({{"scene", "is refused"}});
  }
  SweepStream DoSweep(const SweepRequest& request, const CallOptions& options) const override {
    return SweepStream(
        [options, next = int64_t{0},
         total = request.end_index.value_or(1'000'000)]() mutable -> std::optional<absl::StatusOr<SweepChunk>> {
          if (next == 2) return WorkUntilEnded(options);
          SweepChunk chunk = {.first_index = next, .count = 1, .values = {0.5}, .regimes = {}};
          chunk.points_done = ++next;
          chunk.points_total = total;
          return chunk;
        });
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

class ImpactServiceTest : public testing::Test {
 protected:
  ImpactServiceTest() : nowhere_("/dev/null"), log_(LogFormat::kText, LogLevel::kError, nowhere_) {
    grpc::ServerBuilder builder;
    int port = 0;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port);
    builder.RegisterService(&service_);
    server_ = builder.BuildAndStart();
    stub_ = v1::ImpactService::NewStub(
        grpc::CreateChannel("127.0.0.1:" + std::to_string(port), grpc::InsecureChannelCredentials()));
  }
  ~ImpactServiceTest() override { server_->Shutdown(std::chrono::system_clock::now()); }

  // Waits until no handler runs. Returns false if one still does after ten seconds.
  bool AllEnded() const {
    const auto end = steady_clock::now() + seconds(10);
    while (admission_.live() > 0 && steady_clock::now() < end) std::this_thread::sleep_for(milliseconds(1));
    return admission_.live() == 0;
  }

  std::ofstream nowhere_;
  Log log_;
  Observer observer_{log_};
  FakeSolver solver_;
  std::stop_source streams_;
  std::stop_source unary_;
  Admission admission_{8};
  ImpactService service_{
      solver_, {.streams = streams_.get_token(), .unary = unary_.get_token()}, admission_, observer_};
  std::unique_ptr<grpc::Server> server_;
  std::unique_ptr<v1::ImpactService::Stub> stub_;
};

TEST_F(ImpactServiceTest, PassesTheRequestOnAndTheAnswerBack) {
  grpc::ClientContext context;
  v1::PlanRequest request;
  request.set_relative_tolerance(0.25);
  v1::PlanResponse response;
  ASSERT_TRUE(stub_->Plan(&context, request, &response).ok());
  EXPECT_EQ(response.plan().relative_tolerance(), 0.25);
}

TEST_F(ImpactServiceTest, PassesTheDeadlineOn) {
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + seconds(60));
  v1::SolveResponse response;
  ASSERT_TRUE(stub_->Solve(&context, {}, &response).ok());
  EXPECT_EQ(response.outcome().w_rank(), 2);
  ASSERT_TRUE(solver_.deadline.has_value());
  EXPECT_GT(*solver_.deadline, steady_clock::now() + seconds(30));
  EXPECT_LT(*solver_.deadline, steady_clock::now() + seconds(61));
  grpc::ClientContext unlimited;
  ASSERT_TRUE(stub_->Solve(&unlimited, {}, &response).ok());
  EXPECT_FALSE(solver_.deadline.has_value());
}

TEST_F(ImpactServiceTest, PassesErrorsBack) {
  grpc::ClientContext context;
  v1::AuditResponse response;
  const absl::Status status = FromGrpcStatus(stub_->Audit(&context, {}, &response));
  EXPECT_EQ(ReasonOf(status), ErrorReason::kInvalidRequest);
}

TEST_F(ImpactServiceTest, ACallThatItsClientCancelsEnds) {
  grpc::ClientContext context;
  std::jthread canceller([&context] {
    std::this_thread::sleep_for(milliseconds(50));
    context.TryCancel();
  });
  v1::BoundsResponse response;
  EXPECT_EQ(stub_->Bounds(&context, {}, &response).error_code(), grpc::StatusCode::CANCELLED);
  EXPECT_TRUE(AllEnded());
}

TEST_F(ImpactServiceTest, ASweepEndsWhenTheServerDrains) {
  grpc::ClientContext context;
  const auto reader = stub_->Sweep(&context, {});
  v1::SweepResponse chunk;
  ASSERT_TRUE(reader->Read(&chunk));
  streams_.request_stop();
  while (reader->Read(&chunk)) {
  }
  const absl::Status status = FromGrpcStatus(reader->Finish());
  EXPECT_EQ(status.code(), absl::StatusCode::kUnavailable);
  EXPECT_EQ(ReasonOf(status), ErrorReason::kDraining);
}

TEST_F(ImpactServiceTest, AStudyOfCostIsSentRowByRowAndEndsWhenTheServerDrains) {
  grpc::ClientContext context;
  const auto reader = stub_->Cost(&context, {});
  v1::CostResponse chunk;
  ASSERT_TRUE(reader->Read(&chunk));
  EXPECT_EQ(chunk.rows(0).name(), "row");
  EXPECT_EQ(chunk.rows_total(), 9);
  streams_.request_stop();
  while (reader->Read(&chunk)) {
  }
  const absl::Status status = FromGrpcStatus(reader->Finish());
  EXPECT_EQ(status.code(), absl::StatusCode::kUnavailable);
  EXPECT_EQ(ReasonOf(status), ErrorReason::kDraining);
}

TEST_F(ImpactServiceTest, AUnaryCallRunsOnAfterTheGraceAndIsUnavailableOnceItIsStopped) {
  std::jthread drain([this] {
    std::this_thread::sleep_for(milliseconds(50));
    streams_.request_stop();
    std::this_thread::sleep_for(milliseconds(50));
    EXPECT_EQ(admission_.live(), 1);
    unary_.request_stop();
  });
  grpc::ClientContext context;
  v1::BoundsResponse response;
  const absl::Status status = FromGrpcStatus(stub_->Bounds(&context, {}, &response));
  EXPECT_EQ(status.code(), absl::StatusCode::kUnavailable);
  EXPECT_EQ(ReasonOf(status), ErrorReason::kDraining);
}

TEST_F(ImpactServiceTest, ANewCallIsRefusedAfterTheGrace) {
  streams_.request_stop();
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + seconds(60));
  v1::SolveResponse response;
  const absl::Status status = FromGrpcStatus(stub_->Solve(&context, {}, &response));
  EXPECT_EQ(ReasonOf(status), ErrorReason::kDraining);
  EXPECT_EQ(RetryDelayOf(status), seconds(1));
  EXPECT_FALSE(solver_.deadline.has_value()) << "the solver was called";
}

}  // namespace
}  // namespace ricochet::server
