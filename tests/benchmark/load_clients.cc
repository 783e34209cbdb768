// Clients at once: calls a second and latencies of cheap Solves, from 1 to 64 clients, and beside eight sweeps.
//
// usage: ricochet_load_clients HOST:PORT; prints one line of tab-separated numbers for each count of clients.

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <vector>

#include "absl/synchronization/mutex.h"
#include "ricochet/client.h"
#include "ricochet/solver.h"
#include "tests/benchmark/measure.h"

namespace ricochet::bench {
namespace {

using std::chrono::steady_clock;

constexpr std::chrono::seconds kTime(1);
constexpr int kSweeps = 8;

Scene PaperScene() {
  return {.system = Pendulum{.inertia_kg_m2 = 1.0, .a_m = 0.3, .b_m = 1.0, .omega_minus_rad_s = -1.0},
          .friction = {.kinetic_coefficient = 0.1},
          .restitution = EnergeticCoefficient{1.0}};
}

Client Connect(const char* address) {
  auto client = Client::Connect({.target = address});
  if (!client.ok()) std::abort();
  return *std::move(client);
}

// Latencies in seconds of a client that calls again as soon as it has its answer.
std::vector<double> CallFor(const char* address, steady_clock::time_point end) {
  const Client client = Connect(address);
  const SolveRequest request = {.scene = PaperScene()};
  std::vector<double> seconds;
  while (steady_clock::now() < end) {
    seconds.push_back(Seconds([&] {
      if (!client.Solve(request).ok()) std::abort();
    }));
  }
  return seconds;
}

std::vector<double> Latencies(const char* address, int clients) {
  std::vector<std::vector<double>> each(static_cast<size_t>(clients));
  {
    std::vector<std::jthread> threads;
    const auto end = steady_clock::now() + kTime;
    for (auto& seconds : each) threads.emplace_back([&seconds, address, end] { seconds = CallFor(address, end); });
  }
  std::vector<double> all;
  for (const auto& seconds : each) all.insert(all.end(), seconds.begin(), seconds.end());
  return all;
}

void PrintLine(int clients, int sweeps, const std::vector<double>& seconds) {
  std::printf("%d\t%d\t%.0f\t%.6f\t%.6f\n", clients, sweeps,
              static_cast<double>(seconds.size()) / std::chrono::duration<double>(kTime).count(),
              Quantile(seconds, 0.5), Quantile(seconds, 0.99));
  std::fflush(stdout);
}

// Reads a sweep without an end until it is told to stop.
void SweepUntil(const char* address, const std::atomic<bool>& stop) {
  const Client client = Connect(address);
  const SweepRequest request = {
      .grid = {.scene = PaperScene(),
               .axes = {{.path = "friction.kinetic_coefficient", .values = Linspace{0.0, 0.29, 1'000'000'000}}}},
      .columns = {"coefficients.newton"}};
  for (const absl::StatusOr<SweepChunk>& chunk : client.Sweep(request)) {
    if (!chunk.ok()) std::abort();
    if (stop) return;
  }
}

void Run(const char* address) {
  std::printf("clients\tsweeps\tcalls_per_s\tp50_s\tp99_s\n");
  for (const int clients : {1, 2, 4, 8, 16, 32, 64}) PrintLine(clients, 0, Latencies(address, clients));
  std::atomic<bool> stop = false;
  std::vector<std::jthread> sweeps;
  for (int i = 0; i < kSweeps; ++i) sweeps.emplace_back([&] { SweepUntil(address, stop); });
  std::this_thread::sleep_for(kTime / 2);
  PrintLine(1, kSweeps, Latencies(address, 1));
  stop = true;
}

}  // namespace
}  // namespace ricochet::bench

int main(int argc, char** argv) {
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
  if (argc != 2) {
    std::fprintf(stderr, "usage: ricochet_load_clients HOST:PORT\n");
    return 2;
  }
  ricochet::bench::Run(argv[1]);
  return 0;
}
