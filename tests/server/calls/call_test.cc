// The frame of a call tells the observer what its caller saw, over real sockets.

#include "server/calls/call.h"

#include <gmock/gmock.h>
#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <sstream>
#include <string>
#include <thread>

#include "ricochet/error.h"
#include "ricochet/v1/impact_service.grpc.pb.h"
#include "tests/server/made_frame.h"

namespace ricochet::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::system_clock;
using testing::MatchesRegex;

// Runs `work` in the frame of each Solve.
class Service final : public v1::ImpactService::Service {
 public:
  explicit Service(const Log& log) : observer_(log) {}

  grpc::Status Solve(grpc::ServerContext* context, const v1::SolveRequest* /*request*/,
                     v1::SolveResponse* /*response*/) override {
    grpc::Status status;
    {
      Call call("Solve", Call::Kind::kUnary, *context, made_.frame);
      status = call.Finish(work(*context, call));
    }
    ended.set_value();
    return status;
  }

  std::function<absl::Status(const grpc::ServerContext&, Call&)> work = [](const auto&, auto&) {
    return absl::OkStatus();
  };
  std::promise<void> ended;

 private:
  Observer observer_;
  MadeFrame made_{observer_};
};

class CallTest : public testing::Test {
 protected:
  CallTest() {
    grpc::ServerBuilder builder;
    int port = 0;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port);
    builder.RegisterService(&service_);
    server_ = builder.BuildAndStart();
    const auto channel = grpc::CreateChannel("127.0.0.1:" + std::to_string(port), grpc::InsecureChannelCredentials());
    // A call with a short deadline must reach the server before it expires.
    channel->WaitForConnected(system_clock::now() + seconds(10));
    stub_ = v1::ImpactService::NewStub(channel);
  }
  ~CallTest() override { server_->Shutdown(system_clock::now()); }

  grpc::Status Solve() {
    v1::SolveResponse response;
    return stub_->Solve(&context_, {}, &response);
  }

  // Waits for the end of the handler and returns a field of the call's record, or "absent".
  std::string Logged(const std::string& field) {
    if (record_.fields().empty()) {
      service_.ended.get_future().wait_for(seconds(10));
      EXPECT_TRUE(google::protobuf::util::JsonStringToMessage(out_.str(), &record_).ok()) << out_.str();
    }
    const auto found = record_.fields().find(field);
    return found == record_.fields().end() ? "absent" : found->second.string_value();
  }

  // Returns the request id that the server answered with.
  std::string AnsweredId() const {
    const auto& metadata = context_.GetServerTrailingMetadata();
    const auto found = metadata.find("x-request-id");
    if (found == metadata.end()) return "absent";
    return {found->second.data(), found->second.size()};
  }

  std::ostringstream out_;
  Log log_{LogFormat::kJson, LogLevel::kInfo, out_};
  Service service_{log_};
  std::unique_ptr<grpc::Server> server_;
  std::unique_ptr<v1::ImpactService::Stub> stub_;
  grpc::ClientContext context_;
  google::protobuf::Struct record_;
};

void WaitUntilCancelled(const grpc::ServerContext& context) {
  const auto end = std::chrono::steady_clock::now() + seconds(10);
  while (!context.IsCancelled() && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(milliseconds(1));
}

TEST_F(CallTest, AnAnswerIsLoggedWithItsCaller) {
  ASSERT_TRUE(Solve().ok());
  EXPECT_EQ(Logged("method"), "/ricochet.v1.ImpactService/Solve");
  EXPECT_EQ(Logged("status"), "OK");
  EXPECT_THAT(Logged("user_agent"), testing::StartsWith("grpc-c++/"));
  EXPECT_EQ(Logged("trace_id"), "absent");
  EXPECT_EQ(Logged("reason"), "absent");
}

TEST_F(CallTest, WorkDoneForACallerWhoseDeadlineHasPassedIsDeadlineExceeded) {
  context_.set_deadline(system_clock::now() + milliseconds(200));
  service_.work = [](const grpc::ServerContext& context, Call& /*call*/) {
    std::this_thread::sleep_until(context.deadline() + milliseconds(20));
    return absl::OkStatus();
  };
  EXPECT_EQ(Solve().error_code(), grpc::StatusCode::DEADLINE_EXCEEDED);
  EXPECT_EQ(Logged("status"), "DEADLINE_EXCEEDED");
}

TEST_F(CallTest, WorkDoneForACallerWhoCancelledIsCancelled) {
  std::promise<void> started;
  service_.work = [&started](const grpc::ServerContext& context, Call& /*call*/) {
    started.set_value();
    WaitUntilCancelled(context);
    return absl::OkStatus();
  };
  std::jthread canceller([&] {
    started.get_future().wait_for(seconds(10));
    context_.TryCancel();
  });
  EXPECT_EQ(Solve().error_code(), grpc::StatusCode::CANCELLED);
  EXPECT_EQ(Logged("status"), "CANCELLED");
}

// The frame asks gRPC no more than once a millisecond while a call goes on. Each of these calls is cancelled and ends
// sooner, as far as the machine lets it.
TEST_F(CallTest, WorkDoneForACallerWhoCancelledAMomentAgoIsCancelled) {
  for (int i = 0; i < 20; ++i) {
    out_.str("");
    service_.ended = std::promise<void>();
    grpc::ClientContext caller;
    service_.work = [&caller](const grpc::ServerContext& context, Call& /*call*/) {
      caller.TryCancel();
      const auto end = std::chrono::steady_clock::now() + seconds(10);
      while (!context.IsCancelled() && std::chrono::steady_clock::now() < end) std::this_thread::yield();
      return absl::OkStatus();
    };
    v1::SolveResponse response;
    EXPECT_EQ(stub_->Solve(&caller, {}, &response).error_code(), grpc::StatusCode::CANCELLED);
    ASSERT_EQ(service_.ended.get_future().wait_for(seconds(10)), std::future_status::ready);
    ASSERT_THAT(out_.str(), testing::HasSubstr(R"("status":"CANCELLED")")) << "call " << i;
  }
}

TEST_F(CallTest, ARefusalIsLoggedWithItsReasonAndMessage) {
  service_.work = [](const auto&, auto&) { return InvalidRequest({{"scene", "is refused"}}); };
  EXPECT_FALSE(Solve().ok());
  EXPECT_EQ(Logged("status"), "INVALID_ARGUMENT");
  EXPECT_EQ(Logged("reason"), "INVALID_REQUEST");
  EXPECT_THAT(Logged("message"), testing::HasSubstr("scene"));
}

TEST_F(CallTest, TheCallersRequestIdIsKeptAndAnswered) {
  context_.AddMetadata("x-request-id", "order-66/a");
  ASSERT_TRUE(Solve().ok());
  EXPECT_EQ(AnsweredId(), "order-66/a");
  EXPECT_EQ(Logged("request_id"), "order-66/a");
}

TEST_F(CallTest, AnErrorCarriesTheRequestIdToo) {
  context_.AddMetadata("x-request-id", "order-66/b");
  service_.work = [](const auto&, auto&) { return InvalidRequest({{"scene", "is refused"}}); };
  EXPECT_FALSE(Solve().ok());
  EXPECT_EQ(AnsweredId(), "order-66/b");
  // With initial metadata it would count as an answer, which a client's retry policy does not repeat.
  EXPECT_TRUE(context_.GetServerInitialMetadata().empty());
}

TEST_F(CallTest, ARequestIdIsMadeForACallerWhoSendsNone) {
  ASSERT_TRUE(Solve().ok());
  EXPECT_THAT(AnsweredId(), MatchesRegex("[0-9a-f]{32}"));
  EXPECT_EQ(Logged("request_id"), AnsweredId());
}

TEST_F(CallTest, ARequestIdThatCouldMisleadIsReplaced) {
  context_.AddMetadata("x-request-id", "two words");
  ASSERT_TRUE(Solve().ok());
  EXPECT_THAT(AnsweredId(), MatchesRegex("[0-9a-f]{32}"));
}

TEST_F(CallTest, ARequestIdOfOver128BytesIsReplaced) {
  context_.AddMetadata("x-request-id", std::string(129, 'a'));
  ASSERT_TRUE(Solve().ok());
  EXPECT_THAT(AnsweredId(), MatchesRegex("[0-9a-f]{32}"));
}

TEST_F(CallTest, TheTraceOfTheCallerIsLogged) {
  context_.AddMetadata("traceparent", "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01");
  ASSERT_TRUE(Solve().ok());
  EXPECT_EQ(Logged("trace_id"), "4bf92f3577b34da6a3ce929d0e0e4736");
}

TEST_F(CallTest, WhatTheHandlerLearnedIsLogged) {
  service_.work = [](const auto&, Call& call) {
    CallRecord& record = call.record();
    record.queued_s = 0.25;
    record.points = 12;
    record.first_index = 5;
    record.stalls = 3;
    record.solved_by_model.at(static_cast<size_t>(Model::kPendulum)) = 11;
    return absl::OkStatus();
  };
  ASSERT_TRUE(Solve().ok());
  EXPECT_EQ(Logged("models"), "pendulum:11");
  EXPECT_EQ(record_.fields().at("queued_ms").number_value(), 250.0);
  EXPECT_EQ(record_.fields().at("points").number_value(), 12.0);
  EXPECT_EQ(record_.fields().at("first_index").number_value(), 5.0);
  EXPECT_EQ(record_.fields().at("stalls").number_value(), 3.0);
}

}  // namespace
}  // namespace ricochet::server
