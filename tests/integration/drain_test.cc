// A signal to stop ends a real ricochetd, whatever is connected to it.

#include <gmock/gmock.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <memory>
#include <thread>

#include "grpc/health/v1/health.grpc.pb.h"
#include "ricochet/error.h"
#include "ricochet/v1/impact_service.grpc.pb.h"
#include "tests/support/processes/server_process.h"
#include "tests/support/processes/service_calls.h"

namespace ricochet {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;
using testing::HasSubstr;

// An open Watch of the server's health.
class HealthWatch {
 public:
  explicit HealthWatch(const std::shared_ptr<grpc::Channel>& channel)
      : stub_(grpc::health::v1::Health::NewStub(channel)), reader_(stub_->Watch(&context_, {})) {
    grpc::health::v1::HealthCheckResponse first;
    EXPECT_TRUE(reader_->Read(&first));
  }
  ~HealthWatch() {
    context_.TryCancel();
    reader_->Finish();
  }

 private:
  grpc::ClientContext context_;
  std::unique_ptr<grpc::health::v1::Health::Stub> stub_;
  std::unique_ptr<grpc::ClientReader<grpc::health::v1::HealthCheckResponse>> reader_;
};

// An open stream of reflection on which nothing is asked.
class IdleReflection {
 public:
  explicit IdleReflection(const std::shared_ptr<grpc::Channel>& channel)
      : stub_(channel),
        call_(stub_.PrepareCall(&context_, "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo", &queue_)) {
    call_->StartCall(nullptr);
    Wait();
  }
  ~IdleReflection() {
    context_.TryCancel();
    grpc::Status status;
    call_->Finish(&status, nullptr);
    Wait();
  }

 private:
  void Wait() {
    void* tag = nullptr;
    bool ok = false;
    queue_.Next(&tag, &ok);
  }

  grpc::ClientContext context_;
  grpc::CompletionQueue queue_;
  grpc::GenericStub stub_;
  std::unique_ptr<grpc::GenericClientAsyncReaderWriter> call_;
};

TEST(Drain, DoesNotWaitForWatchesReflectionOrIdleConnections) {
  ServerProcess server({"--drain-timeout", "60"});
  const auto channel = MakeChannel(server.address());
  const HealthWatch watch(channel);
  const IdleReflection reflection(channel);
  const auto before = steady_clock::now();
  EXPECT_EQ(server.Stop(), 0);
  EXPECT_LT(steady_clock::now() - before, seconds(10));
}

TEST(Drain, SecondSignalEndsItWhileASweepWaitsToBeRead) {
  for (const int signal : {SIGTERM, SIGINT, SIGQUIT}) {
    ServerProcess server({"--drain-timeout", "60"});
    const auto stub = MakeStub(server);
    RunningSweep sweep(*stub, SweepOf(kHuge));
    v1::SweepResponse chunk;
    ASSERT_TRUE(sweep.Read(&chunk));
    // This is time enough to fill the connection's window, so that the server waits in a write.
    std::this_thread::sleep_for(milliseconds(300));
    server.Signal(signal);
    server.WaitForLog("draining");
    const auto before = steady_clock::now();
    server.Signal(signal);
    EXPECT_EQ(server.Wait(), 0);
    EXPECT_LT(steady_clock::now() - before, seconds(10));
    EXPECT_EQ(sweep.Drain().code(), absl::StatusCode::kUnavailable);
  }
}

TEST(Drain, OtherSignalsDoNotEndTheServer) {
  ServerProcess server;
  const auto stub = MakeStub(server);
  for (const int signal : {SIGHUP, SIGPIPE, SIGALRM, SIGUSR1, SIGUSR2, SIGXFSZ}) server.Signal(signal);
  EXPECT_THAT(server.WaitForLog("reopening"), HasSubstr("signal=SIGHUP"));
  EXPECT_TRUE(Solve(*stub).ok());
  EXPECT_EQ(server.Stop(), 0);
}

TEST(Drain, CallAfterTheGraceIsRefusedSoThatTheClientAsksAnotherServer) {
  ServerProcess server({"--drain-timeout", "60"});
  const auto stub = MakeStub(server);
  RunningSweep unread(*stub, SweepOf(kHuge));
  v1::SweepResponse chunk;
  ASSERT_TRUE(unread.Read(&chunk));
  std::this_thread::sleep_for(milliseconds(300));
  server.Terminate();
  server.WaitForLog("draining");
  absl::Status status;
  // The end of a grace of no length comes a moment after the log line.
  for (int i = 0; i < 1000 && status.ok(); ++i) status = Solve(*stub);
  EXPECT_EQ(status.code(), absl::StatusCode::kUnavailable);
  EXPECT_EQ(ReasonOf(status), ErrorReason::kDraining);
  EXPECT_EQ(RetryDelayOf(status), seconds(1));
  EXPECT_EQ(unread.Drain().code(), absl::StatusCode::kUnavailable);
  EXPECT_EQ(server.Wait(), 0);
}

}  // namespace
}  // namespace ricochet
