// A real ricochetd under more load than it can carry.

#include <gmock/gmock.h>
#include <google/protobuf/struct.pb.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "proto/wire/status.h"
#include "ricochet/error.h"
#include "ricochet/v1/impact_service.grpc.pb.h"
#include "tests/support/processes/server_process.h"
#include "tests/support/processes/service_calls.h"

namespace ricochet {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;
using std::chrono::system_clock;
using testing::HasSubstr;

using Stub = std::unique_ptr<v1::ImpactService::Stub>;

// A Solve that takes some tens of milliseconds: a chain of links with a certificate.
v1::SolveRequest DearSolve() {
  v1::SolveRequest request;
  v1::Scene& scene = *request.mutable_scene();
  for (int i = 0; i < 24; ++i) {
    v1::Link& link = *scene.mutable_linkage()->add_links();
    link.set_length_m(0.5 + 0.001 * i);
    link.set_mass_kg(1.0 + 0.001 * i);
    link.set_com_m(0.21);
    link.set_inertia_com_kg_m2(0.03);
    link.set_theta_rad(0.3 + 0.001 * i);
    link.set_rate_rad_s(-0.2);
  }
  scene.mutable_friction()->set_kinetic_coefficient(0.2);
  scene.mutable_restitution()->set_energetic(0.7);
  request.set_certified_digits(400);
  return request;
}

absl::Status SolveDear(v1::ImpactService::Stub& stub, milliseconds time) {
  grpc::ClientContext context;
  context.set_deadline(system_clock::now() + time);
  v1::SolveResponse response;
  return FromGrpcStatus(stub.Solve(&context, DearSolve(), &response));
}

// Many calls at once, each on a thread of gRPC.
class Burst {
 public:
  void Add(v1::ImpactService::Stub& stub, const v1::SolveRequest& request) {
    calls_.push_back(std::make_unique<Call>());
    Call& call = *calls_.back();
    call.context.set_deadline(system_clock::now() + seconds(60));
    call.request = request;
    ++open_;
    stub.async()->Solve(&call.context, &call.request, &call.response, [this, &call](grpc::Status status) {
      const std::lock_guard lock(mutex_);
      call.status = FromGrpcStatus(status);
      if (--open_ == 0) ended_.notify_all();
    });
  }

  // Waits for the end of all calls and returns their statuses.
  std::vector<absl::Status> Wait() {
    std::unique_lock lock(mutex_);
    ended_.wait(lock, [this] { return open_ == 0; });
    std::vector<absl::Status> statuses;
    for (const auto& call : calls_) statuses.push_back(call->status);
    return statuses;
  }

 private:
  struct Call {
    grpc::ClientContext context;
    v1::SolveRequest request;
    v1::SolveResponse response;
    absl::Status status;
  };

  std::mutex mutex_;
  std::condition_variable ended_;
  std::atomic<int> open_ = 0;
  std::vector<std::unique_ptr<Call>> calls_;
};

v1::SolveRequest CheapSolve() {
  v1::SolveRequest request;
  *request.mutable_scene() = PaperScene();
  return request;
}

TEST(Overload, BurstOf800CheapCallsIsAnswered) {
  const ServerProcess server;
  std::vector<Stub> stubs;
  for (int i = 0; i < 8; ++i) stubs.push_back(MakeStub(server));
  Burst burst;
  for (int i = 0; i < 800; ++i) burst.Add(*stubs[static_cast<size_t>(i % 8)], CheapSolve());
  for (const absl::Status& status : burst.Wait()) EXPECT_TRUE(status.ok()) << status;
}

TEST(Overload, EveryRefusalHasAReasonAndADelay) {
  const ServerProcess server({"--max-live-calls", "8", "--max-waiting-calls", "1", "--compute-threads", "1"});
  std::vector<Stub> stubs;
  for (int i = 0; i < 8; ++i) stubs.push_back(MakeStub(server));
  Burst burst;
  for (int i = 0; i < 400; ++i) burst.Add(*stubs[static_cast<size_t>(i % 8)], DearSolve());
  int answered = 0;
  for (const absl::Status& status : burst.Wait()) {
    if (status.ok()) {
      ++answered;
      continue;
    }
    EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted) << status;
    EXPECT_THAT(ReasonOf(status), testing::AnyOf(ErrorReason::kTooManyCalls, ErrorReason::kOverloaded)) << status;
    EXPECT_TRUE(RetryDelayOf(status).has_value()) << status;
  }
  EXPECT_GE(answered, 1);
  EXPECT_THAT(server.WaitForLog("reason=OVERLOADED"), HasSubstr("reason=OVERLOADED"));
}

TEST(Overload, DeadlinesAreKeptByMostOfTheCallsThatThereIsTimeFor) {
  const ServerProcess server;
  const Stub first = MakeStub(server);
  const auto before = steady_clock::now();
  ASSERT_TRUE(SolveDear(*first, seconds(60)).ok());
  const auto took = std::chrono::duration_cast<milliseconds>(steady_clock::now() - before);
  // Twenty clients in closed loops, each with a deadline of eight times the time of a call.
  std::atomic<int> answered = 0;
  std::vector<std::jthread> clients;
  for (int i = 0; i < 20; ++i) {
    clients.emplace_back([&] {
      const Stub stub = MakeStub(server);
      const auto end = steady_clock::now() + 60 * took;
      while (steady_clock::now() < end) answered += SolveDear(*stub, 8 * took).ok() ? 1 : 0;
    });
  }
  clients.clear();
  // One core has the time for sixty of them. A server that computes all at once answers next to none.
  EXPECT_GE(answered, 15);
}

TEST(Overload, OneClientLeavesPlacesToOthers) {
  const ServerProcess server({"--max-live-calls", "16"});
  const Stub stub = MakeStub(server);
  std::vector<std::unique_ptr<RunningSweep>> sweeps;
  for (int i = 0; i < 10; ++i) sweeps.push_back(std::make_unique<RunningSweep>(*stub, SweepOf(kHuge)));
  v1::SweepResponse chunk;
  int admitted = 0;
  for (const auto& sweep : sweeps) admitted += sweep->Read(&chunk) ? 1 : 0;
  EXPECT_EQ(admitted, 3);
  EXPECT_TRUE(Solve(*stub).ok()) << "streams leave places to unary calls";
}

TEST(Overload, SweepThatNobodyReadsEndsAndTheLogSaysWhy) {
  const ServerProcess server({"--write-stall-timeout", "0.3"});
  const Stub stub = MakeStub(server);
  RunningSweep sweep(*stub, SweepOf(kHuge));
  v1::SweepResponse chunk;
  ASSERT_TRUE(sweep.Read(&chunk));
  EXPECT_THAT(server.WaitForLog("UNREAD_LIMIT"), HasSubstr("reason=UNREAD_LIMIT"));
  EXPECT_EQ(sweep.Drain().code(), absl::StatusCode::kCancelled);
}

TEST(Overload, UnaryCallEndsAtTheServersLimit) {
  const ServerProcess server({"--max-unary-time", "0.001"});
  const Stub stub = MakeStub(server);
  const absl::Status status = SolveDear(*stub, seconds(60));
  EXPECT_EQ(status.code(), absl::StatusCode::kDeadlineExceeded);
  EXPECT_THAT(std::string(status.message()), HasSubstr("the server's limit"));
}

TEST(Overload, UnaryCallThatRunsAtTheEndOfTheDrainIsUnavailable) {
  ServerProcess server({"--drain-timeout", "0"});
  const Stub stub = MakeStub(server);
  std::atomic<bool> unavailable = false;
  std::jthread client([&] {
    // Calls follow each other until one meets the drain.
    for (absl::Status status; !unavailable;) {
      status = SolveDear(*stub, seconds(60));
      if (status.ok()) continue;
      EXPECT_EQ(status.code(), absl::StatusCode::kUnavailable) << status;
      unavailable = true;
    }
  });
  std::this_thread::sleep_for(milliseconds(200));
  EXPECT_EQ(server.Stop(), 0);
  client.join();
  EXPECT_TRUE(unavailable);
}

}  // namespace
}  // namespace ricochet
