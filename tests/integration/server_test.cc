// Tests of a real ricochetd over real sockets.

#include <gmock/gmock.h>
#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "grpc/health/v1/health.grpc.pb.h"
#include "ricochet/engine_info.h"
#include "ricochet/error.h"
#include "ricochet/v1/impact_service.grpc.pb.h"
#include "tests/support/oracles/ulp.h"
#include "tests/support/processes/server_process.h"
#include "tests/support/processes/service_calls.h"

namespace ricochet {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;
using testing::ElementsAre;
using testing::HasSubstr;

// Returns the fields of the last record of a call of the method, from a log in JSON.
google::protobuf::Struct LastCall(const std::string& log, const std::string& method) {
  google::protobuf::Struct last;
  std::istringstream lines(log);
  for (std::string line; std::getline(lines, line);) {
    google::protobuf::Struct record;
    const auto status = google::protobuf::util::JsonStringToMessage(line, &record);
    EXPECT_TRUE(status.ok()) << line;
    const auto found = record.fields().find("method");
    if (found != record.fields().end() && found->second.string_value() == method) last = record;
  }
  return last;
}

// A place is free again a moment after its call is in the log, when the call's status has been sent.
bool IsSolvedSoon(v1::ImpactService::Stub& stub) {
  for (const auto end = steady_clock::now() + seconds(10); steady_clock::now() < end;) {
    if (Solve(stub).ok()) return true;
  }
  return false;
}

constexpr char kSolveMethod[] = "/ricochet.v1.ImpactService/Solve";
constexpr char kSweepMethod[] = "/ricochet.v1.ImpactService/Sweep";

TEST(Server, SolveGivesThePapersNumber) {
  const ServerProcess server;
  v1::SolveResponse response;
  ASSERT_TRUE(Solve(*MakeStub(server), PaperScene(), &response).ok());
  // Newton = eta sqrt((a - mu b)/(a + mu b)) = sqrt(0.2/0.4) for the scene's decimal numbers; the doubles 0.1 and 0.3
  // move it by a few ulp. [30]
  EXPECT_LE(UlpDistance(response.outcome().coefficients().newton(), std::sqrt(0.5)), 4U);
  EXPECT_EQ(response.outcome().regime(), v1::REGIME_REBOUND);
  EXPECT_EQ(response.engine().fingerprint(), ThisEngine().fingerprint);
  EXPECT_EQ(response.engine().version(), ThisEngine().version);
}

TEST(Server, BoundsAreAnswered) {
  const ServerProcess server;
  grpc::ClientContext context;
  v1::BoundsRequest request;
  v1::BoundsResponse response;
  *request.mutable_scene() = PaperScene();
  request.mutable_scene()->clear_restitution();
  ASSERT_TRUE(MakeStub(server)->Bounds(&context, request, &response).ok());
  EXPECT_LE(UlpDistance(response.bounds().sharp().newton().upper(), std::sqrt(0.5)), 4U);
  EXPECT_EQ(response.engine().fingerprint(), ThisEngine().fingerprint);
}

TEST(Server, SweepArrivesInOrderAndComplete) {
  const ServerProcess server;
  const auto stub = MakeStub(server);
  v1::SweepRequest request = SweepOf(200'001);
  request.add_columns("coefficients.poisson");
  request.set_with_regime(true);
  RunningSweep sweep(*stub, request);
  v1::SweepResponse chunk;
  v1::SweepResponse last;
  int64_t next = 0;
  std::vector<int64_t> counts;
  while (sweep.Read(&chunk)) {
    ASSERT_EQ(chunk.first_index(), next);
    ASSERT_EQ(chunk.values().size(), 2 * 8 * static_cast<size_t>(chunk.count()));
    ASSERT_EQ(chunk.regimes().size(), static_cast<size_t>(chunk.count()));
    ASSERT_EQ(chunk.engine().fingerprint(), ThisEngine().fingerprint);
    ASSERT_LE(chunk.ByteSizeLong(), size_t{1} << 20);
    next += chunk.count();
    ASSERT_EQ(chunk.points_done(), next);
    ASSERT_EQ(chunk.points_total(), 200'001);
    counts.push_back(chunk.count());
    last = chunk;
  }
  EXPECT_TRUE(sweep.Drain().ok());
  EXPECT_EQ(next, 200'001);
  // Chunks grow while their reader comes back at once, which a busy machine may keep it from now and then.
  EXPECT_LT(counts.front(), *std::max_element(counts.begin(), counts.end()));
  ASSERT_TRUE(last.has_summary());
  EXPECT_EQ(last.summary().points(), 200'001);
  EXPECT_GT(last.summary().elapsed_s(), 0.0);
}

TEST(Server, EmptyRangeIsOneChunkWithItsSummary) {
  const ServerProcess server;
  const auto stub = MakeStub(server);
  v1::SweepRequest request = SweepOf(10);
  request.set_first_index(10);
  RunningSweep sweep(*stub, request);
  v1::SweepResponse chunk;
  ASSERT_TRUE(sweep.Read(&chunk));
  EXPECT_EQ(chunk.count(), 0);
  EXPECT_TRUE(chunk.has_summary());
  EXPECT_FALSE(sweep.Read(&chunk));
  EXPECT_TRUE(sweep.Drain().ok());
}

TEST(Server, EveryViolationArrivesWithItsPath) {
  const ServerProcess server;
  v1::Scene scene = PaperScene();
  scene.mutable_pendulum()->set_a_m(-1.0);
  scene.mutable_friction()->set_kinetic_coefficient(-0.1);
  const absl::Status status = Solve(*MakeStub(server), scene);
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(ReasonOf(status), ErrorReason::kInvalidRequest);
  EXPECT_THAT(ViolationsOf(status), ElementsAre(testing::Field(&Violation::field, "pendulum.a_m"),
                                                testing::Field(&Violation::field, "friction.kinetic_coefficient")));
}

TEST(Server, BadGridFailsTheCallBeforeAnyChunk) {
  const ServerProcess server;
  const auto stub = MakeStub(server);
  v1::SweepRequest request = SweepOf(0);
  request.add_columns("coefficients.speed");
  RunningSweep sweep(*stub, request);
  v1::SweepResponse chunk;
  EXPECT_FALSE(sweep.Read(&chunk));
  const absl::Status status = sweep.Drain();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(ViolationsOf(status).size(), 2U);
}

TEST(Server, RequestAboveOneMebibyteIsRefused) {
  const ServerProcess server;
  const auto stub = MakeStub(server);
  v1::SweepRequest request = SweepOf(1);
  for (int i = 0; i < (1 << 17) + 1; ++i) {
    request.mutable_axes(0)->mutable_list()->add_values(0.25);
  }
  RunningSweep sweep(*stub, request);
  EXPECT_EQ(sweep.Drain().code(), absl::StatusCode::kResourceExhausted);
  EXPECT_TRUE(Solve(*stub).ok());
}

TEST(Server, CallIsOneLogLineThatParses) {
  const ServerProcess server({"--log-format", "json"});
  const auto stub = MakeStub(server);
  ASSERT_TRUE(Solve(*stub).ok());
  server.WaitForLog(R"("status":"OK")");  // A call is recorded after its answer, perhaps after the next call's.
  v1::Scene bad = PaperScene();
  bad.clear_restitution();
  ASSERT_FALSE(Solve(*stub, bad).ok());
  const auto record = LastCall(server.WaitForLog("INVALID_ARGUMENT"), kSolveMethod);
  EXPECT_EQ(record.fields().at("event").string_value(), "call");
  EXPECT_EQ(record.fields().at("status").string_value(), "INVALID_ARGUMENT");
  EXPECT_THAT(record.fields().at("peer").string_value(), HasSubstr("127.0.0.1:"));
  EXPECT_GT(record.fields().at("duration_ms").number_value(), 0.0);
  EXPECT_EQ(record.fields().count("points"), 0U);
}

using HealthStatus = grpc::health::v1::HealthCheckResponse;

HealthStatus::ServingStatus CheckHealth(const ServerProcess& server, const std::string& service) {
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + seconds(10));
  grpc::health::v1::HealthCheckRequest request;
  request.set_service(service);
  HealthStatus response;
  const auto status =
      grpc::health::v1::Health::NewStub(MakeChannel(server.address()))->Check(&context, request, &response);
  EXPECT_TRUE(status.ok()) << status.error_message();
  return response.status();
}

TEST(Server, HealthIsServingAndInTheDrainsGraceNotServing) {
  ServerProcess server({"--drain-grace", "30"});
  const auto stub = MakeStub(server);
  EXPECT_EQ(CheckHealth(server, ""), HealthStatus::SERVING);
  EXPECT_EQ(CheckHealth(server, "ricochet.v1.ImpactService"), HealthStatus::SERVING);
  server.Terminate();
  server.WaitForLog("draining");
  EXPECT_EQ(CheckHealth(server, ""), HealthStatus::NOT_SERVING);
  EXPECT_EQ(CheckHealth(server, "ricochet.v1.ImpactService"), HealthStatus::NOT_SERVING);
  EXPECT_TRUE(Solve(*stub).ok()) << "the grace is for clients that have not noticed yet";
  // A second signal ends the grace.
  const auto before = steady_clock::now();
  EXPECT_EQ(server.Stop(), 0);
  EXPECT_LT(steady_clock::now() - before, seconds(10));
}

TEST(Server, IdleServerEndsWithZeroOnSigterm) {
  ServerProcess server;
  EXPECT_EQ(server.Stop(), 0);
  EXPECT_THAT(server.log(), HasSubstr("stopped"));
}

TEST(Server, DrainEndsARunningSweepWithRetryInfo) {
  ServerProcess server({"--log-format", "json"});
  const auto stub = MakeStub(server);
  RunningSweep sweep(*stub, SweepOf(kHuge));
  v1::SweepResponse chunk;
  ASSERT_TRUE(sweep.Read(&chunk));
  const auto before = steady_clock::now();
  server.Terminate();
  const absl::Status status = sweep.Drain();
  EXPECT_EQ(status.code(), absl::StatusCode::kUnavailable);
  EXPECT_EQ(ReasonOf(status), ErrorReason::kDraining);
  EXPECT_EQ(RetryDelayOf(status), seconds(1));
  EXPECT_EQ(server.Wait(), 0);
  EXPECT_LT(steady_clock::now() - before, seconds(10));
  const auto record = LastCall(server.log(), kSweepMethod);
  EXPECT_EQ(record.fields().at("status").string_value(), "UNAVAILABLE");
}

TEST(Server, DrainTimeoutEndsASweepThatNobodyReads) {
  ServerProcess server({"--drain-timeout", "0.5"});
  const auto stub = MakeStub(server);
  RunningSweep sweep(*stub, SweepOf(kHuge));
  v1::SweepResponse chunk;
  ASSERT_TRUE(sweep.Read(&chunk));
  // This is time enough to fill the connection's window, so that the server waits in a write.
  std::this_thread::sleep_for(milliseconds(300));
  const auto before = steady_clock::now();
  EXPECT_EQ(server.Stop(), 0);
  EXPECT_LT(steady_clock::now() - before, seconds(5));
  EXPECT_FALSE(sweep.Drain().ok());
}

TEST(Server, CancelledSweepStopsWorkingAndFreesTheServer) {
  const ServerProcess server({"--log-format", "json", "--max-live-calls", "1"});
  const auto stub = MakeStub(server);
  RunningSweep sweep(*stub, SweepOf(kHuge));
  v1::SweepResponse chunk;
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(sweep.Read(&chunk));
  sweep.Cancel();
  EXPECT_EQ(sweep.Drain().code(), absl::StatusCode::kCancelled);
  const auto record = LastCall(server.WaitForLog("CANCELLED"), kSweepMethod);
  ASSERT_EQ(record.fields().count("points"), 1U);
  EXPECT_EQ(record.fields().at("status").string_value(), "CANCELLED");
  EXPECT_LT(record.fields().at("points").number_value(), 0.01 * kHuge);
  EXPECT_TRUE(IsSolvedSoon(*stub));
}

TEST(Server, DeadlineEndsASweepPromptly) {
  const ServerProcess server({"--log-format", "json"});
  const auto stub = MakeStub(server);
  const auto before = steady_clock::now();
  RunningSweep sweep(*stub, SweepOf(kHuge), milliseconds(200));
  EXPECT_EQ(sweep.Drain().code(), absl::StatusCode::kDeadlineExceeded);
  EXPECT_LT(steady_clock::now() - before, seconds(5));
  const auto record = LastCall(server.WaitForLog("\"points\""), kSweepMethod);
  ASSERT_EQ(record.fields().count("points"), 1U);
  EXPECT_LT(record.fields().at("points").number_value(), 0.1 * kHuge);
  // The clock of the client may cancel the call first.
  EXPECT_THAT(record.fields().at("status").string_value(), testing::AnyOf("DEADLINE_EXCEEDED", "CANCELLED"));
}

TEST(Server, CallAboveTheLimitIsRefusedAndLaterTaken) {
  const ServerProcess server({"--log-format", "json", "--max-live-calls", "1"});
  const auto stub = MakeStub(server);
  RunningSweep sweep(*stub, SweepOf(kHuge));
  v1::SweepResponse chunk;
  ASSERT_TRUE(sweep.Read(&chunk));
  const absl::Status refused = Solve(*stub);
  EXPECT_EQ(refused.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(ReasonOf(refused), ErrorReason::kTooManyCalls);
  EXPECT_EQ(RetryDelayOf(refused), seconds(1));
  sweep.Cancel();
  EXPECT_EQ(sweep.Drain().code(), absl::StatusCode::kCancelled);
  server.WaitForLog("CANCELLED");
  EXPECT_TRUE(IsSolvedSoon(*stub));
}

TEST(Server, SweepAboveTheLimitOfPointsIsRefusedButItsSubRangeIsNot) {
  const ServerProcess server({"--max-points-per-sweep", "1000"});
  const auto stub = MakeStub(server);
  v1::SweepRequest request = SweepOf(1001);
  const absl::Status refused = RunningSweep(*stub, request).Drain();
  EXPECT_EQ(refused.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(ReasonOf(refused), ErrorReason::kSweepTooLarge);
  EXPECT_FALSE(RetryDelayOf(refused).has_value()) << "the same sweep will be refused again";
  EXPECT_THAT(std::string(refused.message()), HasSubstr("1001 points"));
  request.set_first_index(1);
  EXPECT_TRUE(RunningSweep(*stub, request).Drain().ok());
}

TEST(Server, TakenPortIsAClearError) {
  const ServerProcess server;
  const Ending ending = RunServerToEnd({"--listen", server.address()});
  EXPECT_EQ(ending.exit_status, 1);
  EXPECT_THAT(ending.output, HasSubstr("cannot listen on " + server.address() + ": Address already in use"));
}

TEST(Server, UnwritablePortFileIsAClearError) {
  const Ending ending = RunServerToEnd({"--listen", "127.0.0.1:0", "--port-file", "/nonexistent/port"});
  EXPECT_EQ(ending.exit_status, 1);
  EXPECT_THAT(ending.output, HasSubstr("cannot write /nonexistent/port"));
}

TEST(Server, BadOptionsExitWithTwo) {
  const Ending ending = RunServerToEnd({"--listen", "0.0.0.0:0", "--max-live-calls", "0"});
  EXPECT_EQ(ending.exit_status, 2);
  EXPECT_THAT(ending.output, HasSubstr("--listen = 0.0.0.0:0: must be a loopback address"));
  EXPECT_THAT(ending.output, HasSubstr("--max-live-calls = 0: must be an integer"));
}

TEST(Server, VersionExitsWithZero) {
  const Ending ending = RunServerToEnd({"--version"});
  EXPECT_EQ(ending.exit_status, 0);
  EXPECT_THAT(ending.output, HasSubstr("ricochetd " + ThisEngine().version));
}

}  // namespace
}  // namespace ricochet
