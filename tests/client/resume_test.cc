// Sweeps whose servers die: real processes, ended at a random chunk, and another server that goes on.
//
// RICOCHET_RESUMES=N ends N servers in each way instead of a few, for long runs.

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <functional>
#include <memory>
#include <random>
#include <string>

#include "ricochet/client.h"
#include "tests/support/server_process.h"

namespace ricochet {
namespace {

int Times() {
  const char* const asked = std::getenv("RICOCHET_RESUMES");
  return asked == nullptr ? 3 : std::atoi(asked);
}

SweepRequest Request() {
  SweepRequest request;
  request.grid.scene.system = Pendulum{.inertia_kg_m2 = 1.0, .a_m = 0.3, .b_m = 1.0, .omega_minus_rad_s = -1.0};
  request.grid.scene.restitution = EnergeticCoefficient{1.0};
  request.grid.axes = {{"friction.kinetic_coefficient", Linspace{-0.1, 0.4, 1'000'000}}};
  request.columns = {"coefficients.newton"};
  request.with_regime = true;
  return request;
}

// The answer of a sweep of one column, but its time.
struct Answer {
  std::string values;  // Their bytes.
  std::vector<Regime> regimes;
  SweepSummary summary;
  friend bool operator==(const Answer&, const Answer&) = default;
};

Answer Collect(SweepStream stream, const std::function<void(int)>& before_chunk) {
  Answer answer;
  int number = 0;
  for (const absl::StatusOr<SweepChunk>& chunk : stream) {
    EXPECT_TRUE(chunk.ok()) << chunk.status();
    if (!chunk.ok()) break;
    before_chunk(number++);
    answer.values.append(reinterpret_cast<const char*>(chunk->values.data()), chunk->values.size() * sizeof(double));
    answer.regimes.insert(answer.regimes.end(), chunk->regimes.begin(), chunk->regimes.end());
    if (chunk->summary.has_value()) answer.summary = Joined(*chunk->summary, {});
  }
  return answer;
}

class ResumeTest : public testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(Signals, ResumeTest, testing::Values(SIGKILL, SIGTERM), [](const auto& parameter) {
  return std::string(parameter.param == SIGKILL ? "Kill" : "Drain");
});

TEST_P(ResumeTest, AServerThatEndsAtARandomChunkChangesNoBit) {
  const Answer undisturbed = Collect(LocalSolver().Sweep(Request()), [](int /*chunk*/) {});
  const auto seed = std::random_device()();
  std::mt19937 random(seed);
  ServerProcess steady;
  for (int i = 0; i < Times(); ++i) {
    ServerProcess dying;
    const Client client = Client::Connect({.target = dying.address() + "," + steady.address()}).value();
    const int last = static_cast<int>(random() % 12);
    const Answer answer = Collect(client.Sweep(Request()), [&](int chunk) {
      if (chunk == last) kill(dying.pid(), GetParam());
    });
    // A comparison that fails would print megabytes.
    EXPECT_TRUE(answer == undisturbed) << "seed " << seed << ", time " << i << ", chunk " << last;
  }
}

TEST(Resume, GoesOnWithTheOnlyServerWhenItIsBack) {
  const Answer undisturbed = Collect(LocalSolver().Sweep(Request()), [](int /*chunk*/) {});
  auto server = std::make_unique<ServerProcess>();
  const std::string address = server->address();
  const Client client = Client::Connect({.target = address}).value();
  const Answer answer = Collect(client.Sweep(Request()), [&](int chunk) {
    if (chunk != 2) return;
    kill(server->pid(), SIGKILL);
    server->Wait();
    server.reset();
    server = std::make_unique<ServerProcess>(std::vector<std::string>{"--listen", address});
  });
  EXPECT_TRUE(answer == undisturbed);
}

TEST(Resume, AUnaryCallGoesToTheServerThatLives) {
  const ServerProcess living;
  const Client client = Client::Connect({.target = "127.0.0.1:1," + living.address()}).value();
  for (int i = 0; i < 3; ++i) {
    const auto response = client.Solve({.scene = Request().grid.scene, .history_at_n_s = {}});
    EXPECT_TRUE(response.ok()) << response.status();
  }
}

}  // namespace
}  // namespace ricochet
