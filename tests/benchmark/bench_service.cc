// The price of serving: the service on loopback is compared with one that moves the same messages and computes nothing.

#include <grpcpp/grpcpp.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "absl/synchronization/mutex.h"
#include "proto/wire/requests.h"
#include "proto/wire/sweep.h"
#include "ricochet/engine_info.h"
#include "ricochet/solver.h"
#include "server/base/log.h"
#include "server/calls/bounded_service.h"
#include "server/calls/call.h"
#include "server/calls/impact_service.h"
#include "server/telemetry/observer.h"
#include "tests/benchmark/echo_service.h"
#include "tests/benchmark/measure.h"
#include "tests/server/made_frame.h"

namespace ricochet::bench {
namespace {

constexpr int kRounds = 9;
constexpr int64_t kSweepPoints = 4'000'000;

// A service on a loopback port of its own and a stub that reaches it.
class Loopback {
 public:
  explicit Loopback(grpc::Service* service) {
    int port = 0;
    grpc::ServerBuilder builder;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port);
    builder.RegisterService(service);
    server_ = builder.BuildAndStart();
    stub_ = v1::ImpactService::NewStub(
        grpc::CreateChannel(absl::StrFormat("127.0.0.1:%d", port), grpc::InsecureChannelCredentials()));
  }
  v1::ImpactService::Stub& stub() { return *stub_; }

 private:
  std::unique_ptr<grpc::Server> server_;
  std::unique_ptr<v1::ImpactService::Stub> stub_;
};

Scene PaperScene() {
  return {.system = Pendulum{.inertia_kg_m2 = 1.0, .a_m = 0.3, .b_m = 1.0, .omega_minus_rad_s = -1.0},
          .friction = {.kinetic_coefficient = 0.1},
          .restitution = EnergeticCoefficient{1.0}};
}

SweepRequest SweepOf(std::vector<std::string> columns, int64_t points) {
  return {.grid = {.scene = PaperScene(),
                   .axes = {{.path = "friction.kinetic_coefficient", .values = Linspace{0.0, 0.29, points}}}},
          .columns = std::move(columns),
          .end_index = points};
}

v1::SweepRequest EightColumnSweep(int64_t points) {
  return ToProto(
      SweepOf({"coefficients.newton", "coefficients.poisson", "coefficients.tangential", "rates_after_rad_s[0]",
               "impulse.normal_total_n_s", "impulse.tangential_n_s[0]", "work.normal_total_j", "energy_change_j"},
              points));
}

// Reads a whole sweep; returns the bytes of its values.
double ReadSweep(v1::ImpactService::Stub& stub, const v1::SweepRequest& request) {
  grpc::ClientContext context;
  const auto reader = stub.Sweep(&context, request);
  v1::SweepResponse response;
  double bytes = 0.0;
  while (reader->Read(&response)) bytes += static_cast<double>(response.values().size());
  if (!reader->Finish().ok()) std::abort();
  return bytes;
}

void StreamedSweep(Loopback& ricochet, Loopback& echo) {
  const v1::SweepRequest request = EightColumnSweep(kSweepPoints);
  double bytes = 0.0;
  const Comparison time = Compare(
      kRounds, [&] { bytes = ReadSweep(ricochet.stub(), request); },
      [&] { DoNotOptimize(ReadSweep(echo.stub(), request)); });
  std::printf("Streamed sweep, 8 columns, %.0e points\n", static_cast<double>(kSweepPoints));
  Print("ricochet", absl::StrFormat("%.1f M points/s", kSweepPoints / time.seconds_a / 1e6),
        absl::StrFormat("%.2f GB/s", bytes / time.seconds_a / 1e9));
  Print("equal messages, nothing computed", absl::StrFormat("%.1f M points/s", kSweepPoints / time.seconds_b / 1e6),
        absl::StrFormat("%.2f GB/s", bytes / time.seconds_b / 1e9));
  Print("ratio of rates", absl::StrFormat("%.2f", 1.0 / time.ratio),
        "ricochet / nothing computed, median of rounds; goal 0.9");
}

// The columns of a pendulum, in the order of its outcome.
constexpr const char* kColumns[] = {
    "coefficients.newton",
    "coefficients.poisson",
    "coefficients.energetic",
    "coefficients.tangential",
    "rates_after_rad_s[0]",
    "contact_velocity_after.tangential_m_s[0]",
    "contact_velocity_after.normal_m_s",
    "impulse.normal_compression_n_s",
    "impulse.normal_total_n_s",
    "impulse.tangential_n_s[0]",
    "work.normal_compression_j",
    "work.normal_restitution_j",
    "work.tangential_compression_j",
    "work.tangential_restitution_j",
    "work.normal_total_j",
    "work.tangential_total_j",
    "work.friction_dissipation_j",
    "work.tangential_spring_j",
    "energy_change_j",
};

// Reads a whole sweep in this process; returns the bytes of its values.
double ReadLocally(const SweepRequest& request) {
  double bytes = 0.0;
  for (const absl::StatusOr<SweepChunk>& chunk : LocalSolver().Sweep(request)) {
    if (!chunk.ok()) std::abort();
    bytes += 8.0 * static_cast<double>(chunk->values.size());
  }
  return bytes;
}

// A sweep in this process, the same served, and a stream of messages of the same sizes, for several numbers of columns.
void SweepByColumns(Loopback& ricochet, Loopback& echo) {
  constexpr int64_t kPoints = 500'000;
  std::printf("Sweep by columns, %.0e points, medians of %d rounds\n", static_cast<double>(kPoints), kRounds);
  std::printf("  %7s %14s %14s %16s %14s %16s\n", "columns", "local M/s", "served M/s", "empty stream M/s",
              "served/local", "served/empty");
  for (const size_t count : {1u, 2u, 4u, 8u, 12u, 16u, 19u}) {
    const SweepRequest request = SweepOf({std::begin(kColumns), std::begin(kColumns) + count}, kPoints);
    const v1::SweepRequest wire = ToProto(request);
    const auto served = [&] { DoNotOptimize(ReadSweep(ricochet.stub(), wire)); };
    const Comparison local = Compare(kRounds, served, [&] { DoNotOptimize(ReadLocally(request)); });
    const Comparison empty = Compare(kRounds, served, [&] { DoNotOptimize(ReadSweep(echo.stub(), wire)); });
    std::printf("  %7zu %14.1f %14.1f %16.1f %12.2f x %14.2f x\n", count, kPoints / local.seconds_b / 1e6,
                kPoints / empty.seconds_a / 1e6, kPoints / empty.seconds_b / 1e6, local.ratio, empty.ratio);
    std::fflush(stdout);
  }
}

// The median time of one unary call.
double UnaryP50(v1::ImpactService::Stub& stub, const v1::SolveRequest& request) {
  std::vector<double> seconds;
  for (int i = 0; i < 2000; ++i) {
    seconds.push_back(Seconds([&] {
      grpc::ClientContext context;
      v1::SolveResponse response;
      if (!stub.Solve(&context, request, &response).ok()) std::abort();
    }));
  }
  return Median(seconds);
}

// The median time of one call in this process, in which 100 calls make a sample.
double LocalP50(const SolveRequest& request) {
  constexpr int kCalls = 100;
  std::vector<double> seconds;
  for (int i = 0; i < 100; ++i) {
    seconds.push_back(Seconds([&] {
      for (int k = 0; k < kCalls; ++k) DoNotOptimize(LocalSolver().Solve(request)->outcome.coefficients.newton);
    }));
  }
  return Median(seconds) / kCalls;
}

void UnaryCalls(Loopback& ricochet, Loopback& echo) {
  const SolveRequest request = {.scene = PaperScene()};
  const v1::SolveRequest solve = ToProto(request);
  std::vector<double> of_solve, of_equal, of_empty, to_equal, to_empty;
  for (int i = 0; i < kRounds; ++i) {
    of_solve.push_back(UnaryP50(ricochet.stub(), solve));
    of_equal.push_back(UnaryP50(echo.stub(), solve));
    of_empty.push_back(UnaryP50(echo.stub(), v1::SolveRequest()));
    to_equal.push_back(of_solve.back() / of_equal.back());
    to_empty.push_back(of_solve.back() / of_empty.back());
  }
  const auto us = [](const std::vector<double>& seconds) { return absl::StrFormat("%.0f us", Median(seconds) * 1e6); };
  std::printf("Unary call, p50 of 2000, one at a time; ratios are medians of rounds\n");
  Print("Solve", us(of_solve), "");
  Print("equal messages, nothing computed", us(of_equal),
        absl::StrFormat("a Solve takes %.2f x as long; goal 1.15", Median(to_equal)));
  Print("empty call", us(of_empty), absl::StrFormat("a Solve takes %.2f x as long; goal 1.2", Median(to_empty)));
  const double local = LocalP50(request);
  Print("Solve in this process", absl::StrFormat("%.2f us", local * 1e6),
        absl::StrFormat("the wire adds %.0f times as much", Median(of_solve) / local));
}

// Seconds from a client's cancel until the handler has left, told by its slot being free again.
double CancelOnce(v1::ImpactService::Stub& stub, const server::LiveCalls& live_calls) {
  const v1::SweepRequest endless = EightColumnSweep(1'000'000'000);
  grpc::ClientContext context;
  const auto reader = stub.Sweep(&context, endless);
  v1::SweepResponse response;
  for (int i = 0; i < 3; ++i) reader->Read(&response);
  return Seconds([&] {
    context.TryCancel();
    while (live_calls.live() > 0) std::this_thread::yield();
    while (reader->Read(&response)) continue;
    (void)reader->Finish();
  });
}

void CancellationLatency(Loopback& ricochet, const server::LiveCalls& live_calls) {
  std::vector<double> seconds;
  for (int i = 0; i < 21; ++i) seconds.push_back(CancelOnce(ricochet.stub(), live_calls));
  std::printf("Cancelling a streamed sweep of 10^9 points\n");
  Print("from the client's cancel to the handler's end", absl::StrFormat("%.0f us", Median(seconds) * 1e6), "median");
}

void RunAll() {
  std::ofstream nowhere("/dev/null");
  const server::Log log(server::LogFormat::kText, server::LogLevel::kError, nowhere);
  const LocalSolver solver;
  const server::Observer observer(log);
  server::MadeFrame made(observer);
  server::ImpactService service(solver, made.frame, ServerLimits());
  EchoService nothing(ToProto(*solver.Solve({.scene = PaperScene()})));
  const auto answer_batches = [&service](grpc::ServerContext& context, server::BoundedBatches& batches) {
    return service.AnswerBatches(context, batches);
  };
  server::BoundedService bounded(service, answer_batches, Limits(), {.unread = made.unread, .memory = made.memory});
  Loopback ricochet(&bounded);
  Loopback echo(&nothing);
  std::printf("ricochet service on loopback, engine %s\n", ThisEngine().fingerprint.c_str());
  StreamedSweep(ricochet, echo);
  SweepByColumns(ricochet, echo);
  UnaryCalls(ricochet, echo);
  CancellationLatency(ricochet, made.live_calls);
}

}  // namespace
}  // namespace ricochet::bench

int main() {
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
  ricochet::bench::RunAll();
}
