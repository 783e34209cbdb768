// The handlers pass requests and options on to any Solver, and its answers and errors back.

#include "server/calls/impact_service.h"

#include <gmock/gmock.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "proto/wire/status.h"
#include "ricochet/error.h"
#include "tests/server/fake_solver.h"
#include "tests/server/made_frame.h"

namespace ricochet::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

class ImpactServiceTest : public testing::Test {
 protected:
  ImpactServiceTest() : nowhere_("/dev/null"), log_(LogFormat::kText, LogLevel::kError, nowhere_) {
    Serve(made_.frame);
  }
  ~ImpactServiceTest() override { server_->Shutdown(std::chrono::system_clock::now()); }

  // Starts a server whose calls share `frame`, in place of the one before.
  void Serve(const CallFrame& frame) {
    if (server_ != nullptr) server_->Shutdown(std::chrono::system_clock::now());
    server_.reset();
    service_.emplace(solver_, frame, ServerLimits{.max_streams = 5});
    grpc::ServerBuilder builder;
    int port = 0;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port);
    builder.RegisterService(&*service_);
    server_ = builder.BuildAndStart();
    stub_ = v1::ImpactService::NewStub(
        grpc::CreateChannel("127.0.0.1:" + std::to_string(port), grpc::InsecureChannelCredentials()));
  }

  // Waits until no handler runs. Returns false if one still does after ten seconds.
  bool AllEnded() const {
    const auto end = steady_clock::now() + seconds(10);
    while (made_.live_calls.live() > 0 && steady_clock::now() < end) std::this_thread::sleep_for(milliseconds(1));
    return made_.live_calls.live() == 0;
  }

  std::ofstream nowhere_;
  Log log_;
  Observer observer_{log_};
  FakeSolver solver_;
  std::stop_source streams_;
  std::stop_source unary_;
  MadeFrame made_{observer_, {.streams = streams_.get_token(), .unary = unary_.get_token()}};
  std::optional<ImpactService> service_;
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
  ASSERT_TRUE(solver_.deadline.has_value()) << "the server has a limit of its own";
  EXPECT_LT(*solver_.deadline, steady_clock::now() + TimeLimits().unary_time);
}

TEST_F(ImpactServiceTest, InfoHasTheLimitsOfTheServerBesidesThoseOfTheSolver) {
  grpc::ClientContext context;
  v1::InfoResponse response;
  ASSERT_TRUE(stub_->Info(&context, {}, &response).ok());
  EXPECT_EQ(response.limits().max_links(), 7);
  EXPECT_EQ(response.systems(0), "pendulum");
  EXPECT_EQ(response.server_limits().max_streams(), 5);
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
    EXPECT_EQ(made_.live_calls.live(), 1);
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

TEST_F(ImpactServiceTest, AUnaryCallEndsAtTheServersLimitOfTime) {
  MadeFrame made(observer_, {}, {.unary_time = milliseconds(30), .stream_age = milliseconds(30)});
  Serve(made.frame);
  grpc::ClientContext context;
  v1::BoundsResponse response;
  const absl::Status status = FromGrpcStatus(stub_->Bounds(&context, {}, &response));
  EXPECT_EQ(status.code(), absl::StatusCode::kDeadlineExceeded);
  EXPECT_EQ(ReasonOf(status), ErrorReason::kTimeLimit);
  EXPECT_THAT(std::string(status.message()), testing::HasSubstr("30 ms, the server's limit"));
}

TEST_F(ImpactServiceTest, AStreamEndsAtTheServersLimitOfAgeSoThatItsClientAsksForTheRest) {
  MadeFrame made(observer_, {}, {.unary_time = milliseconds(30), .stream_age = milliseconds(30)});
  Serve(made.frame);
  grpc::ClientContext context;
  const auto reader = stub_->Sweep(&context, {});
  v1::SweepResponse chunk;
  while (reader->Read(&chunk)) {
  }
  const absl::Status status = FromGrpcStatus(reader->Finish());
  EXPECT_EQ(status.code(), absl::StatusCode::kUnavailable);
  EXPECT_EQ(ReasonOf(status), ErrorReason::kAgeLimit);
  EXPECT_EQ(RetryDelayOf(status), seconds(0));
}

TEST_F(ImpactServiceTest, AStreamThatNobodyReadsEndsAndGivesItsPlaceBack) {
  MadeFrame made(observer_, {}, {}, milliseconds(100));
  Serve(made.frame);
  solver_.values = 1 << 17;
  solver_.most_chunks = 1000;
  grpc::ClientContext context;
  const auto reader = stub_->Sweep(&context, {});
  const auto end = steady_clock::now() + seconds(10);
  while (made.live_calls.live() == 0 && steady_clock::now() < end) std::this_thread::sleep_for(milliseconds(1));
  EXPECT_EQ(made.live_calls.live(), 1);
  while (made.live_calls.live() > 0 && steady_clock::now() < end) std::this_thread::sleep_for(milliseconds(1));
  EXPECT_EQ(made.live_calls.live(), 0);
  v1::SweepResponse chunk;
  while (reader->Read(&chunk)) {
  }
  EXPECT_EQ(reader->Finish().error_code(), grpc::StatusCode::CANCELLED);
}

}  // namespace
}  // namespace ricochet::server
