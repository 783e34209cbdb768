// The price of serving: the service on loopback is compared with one that moves the same messages and computes nothing.

#include <grpcpp/grpcpp.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "absl/strings/str_format.h"
#include "absl/synchronization/mutex.h"
#include "core/engine/engine.h"
#include "proto/wire/requests.h"
#include "proto/wire/sweep.h"
#include "ricochet/solver.h"
#include "server/admission.h"
#include "server/impact_service.h"
#include "server/log.h"
#include "tests/benchmark/echo_service.h"
#include "tests/benchmark/measure.h"

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

v1::SweepRequest EightColumnSweep(int64_t points) {
  SweepRequest request = {
      .grid = {.scene = PaperScene(),
               .axes = {{.path = "friction.kinetic_coefficient", .values = Linspace{0.0, 0.29, points}}}},
      .columns = {"coefficients.newton", "coefficients.poisson", "coefficients.tangential", "rates_after_rad_s[0]",
                  "impulse.normal_total_n_s", "impulse.tangential_n_s[0]", "work.normal_total_j", "energy_change_j"},
      .end_index = points};
  return ToProto(request);
}

// Reads a whole sweep; returns the bytes of its values.
double ReadSweep(v1::ImpactService::Stub& stub, const v1::SweepRequest& request) {
  grpc::ClientContext context;
  const auto reader = stub.Sweep(&context, request);
  v1::SweepResponse response;
  double bytes = 0.0;
  while (reader->Read(&response)) bytes += 8.0 * response.values_size();
  if (!reader->Finish().ok()) std::abort();
  return bytes;
}

void StreamedSweep(Loopback& ricochet, Loopback& echo) {
  const v1::SweepRequest request = EightColumnSweep(kSweepPoints);
  double bytes = 0.0;
  const Comparison time = Compare(
      kRounds, [&] { bytes = ReadSweep(ricochet.stub(), request); }, [&] { Keep(ReadSweep(echo.stub(), request)); });
  std::printf("Streamed sweep, 8 columns, %.0e points\n", static_cast<double>(kSweepPoints));
  Print("ricochet", absl::StrFormat("%.1f M points/s", kSweepPoints / time.seconds_a / 1e6),
        absl::StrFormat("%.2f GB/s", bytes / time.seconds_a / 1e9));
  Print("equal messages, nothing computed", absl::StrFormat("%.1f M points/s", kSweepPoints / time.seconds_b / 1e6),
        absl::StrFormat("%.2f GB/s", bytes / time.seconds_b / 1e9));
  Print("ratio of rates", absl::StrFormat("%.2f", 1.0 / time.ratio), "ricochet / nothing computed, median of rounds");
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

void UnaryCalls(Loopback& ricochet, Loopback& echo) {
  const v1::SolveRequest solve = ToProto(SolveRequest{.scene = PaperScene()});
  std::vector<double> of_solve;
  std::vector<double> of_empty;
  std::vector<double> ratios;
  for (int i = 0; i < kRounds; ++i) {
    of_solve.push_back(UnaryP50(ricochet.stub(), solve));
    of_empty.push_back(UnaryP50(echo.stub(), v1::SolveRequest()));
    ratios.push_back(of_solve.back() / of_empty.back());
  }
  std::printf("Unary call, p50 of 2000, one at a time\n");
  Print("Solve", absl::StrFormat("%.0f us", Median(of_solve) * 1e6), "");
  Print("empty call", absl::StrFormat("%.0f us", Median(of_empty) * 1e6), "");
  Print("ratio", absl::StrFormat("%.2f x", Median(ratios)), "Solve / empty, median of rounds");
}

// Seconds from a client's cancel until the handler has left, told by its slot being free again.
double CancelOnce(v1::ImpactService::Stub& stub, const server::Admission& admission) {
  const v1::SweepRequest endless = EightColumnSweep(1'000'000'000);
  grpc::ClientContext context;
  const auto reader = stub.Sweep(&context, endless);
  v1::SweepResponse response;
  for (int i = 0; i < 3; ++i) reader->Read(&response);
  return Seconds([&] {
    context.TryCancel();
    while (admission.live() > 0) std::this_thread::yield();
    while (reader->Read(&response)) continue;
    (void)reader->Finish();
  });
}

void CancellationLatency(Loopback& ricochet, const server::Admission& admission) {
  std::vector<double> seconds;
  for (int i = 0; i < 21; ++i) seconds.push_back(CancelOnce(ricochet.stub(), admission));
  std::printf("Cancelling a streamed sweep of 10^9 points\n");
  Print("from the client's cancel to the handler's end", absl::StrFormat("%.0f us", Median(seconds) * 1e6), "median");
}

void RunAll() {
  std::ofstream nowhere("/dev/null");
  const server::Log log(server::LogFormat::kText, server::LogLevel::kError, nowhere);
  const LocalSolver solver;
  const std::stop_source drain;
  server::Admission admission(64);
  server::ImpactService service(solver, int64_t{1} << 53, drain.get_token(), admission, log);
  EchoService nothing;
  Loopback ricochet(&service);
  Loopback echo(&nothing);
  std::printf("ricochet service on loopback, engine %s\n", ThisEngine().fingerprint.c_str());
  StreamedSweep(ricochet, echo);
  UnaryCalls(ricochet, echo);
  CancellationLatency(ricochet, admission);
}

}  // namespace
}  // namespace ricochet::bench

int main() {
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
  ricochet::bench::RunAll();
}
