// Sweeps whose servers die: real processes, ended at a random chunk, and another server that goes on.
//
// RICOCHET_RESUMES=N ends N servers in each way instead of a few, for long runs.

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <memory>
#include <random>
#include <string>

#include "ricochet/client.h"
#include "tests/client/collected_sweep.h"
#include "tests/support/processes/server_process.h"

namespace ricochet {
namespace {

constexpr int64_t kPoints = 1'000'000;

int Times() {
  const char* const asked = std::getenv("RICOCHET_RESUMES");
  return asked == nullptr ? 3 : std::atoi(asked);
}

class ResumeTest : public testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(Signals, ResumeTest, testing::Values(SIGKILL, SIGTERM), [](const auto& parameter) {
  return std::string(parameter.param == SIGKILL ? "Kill" : "Drain");
});

TEST_P(ResumeTest, AServerThatEndsAtARandomChunkChangesNoBit) {
  const CollectedSweep undisturbed = Collect(LocalSolver().Sweep(MixedSweep(kPoints)));
  const auto seed = std::random_device()();
  std::mt19937 random(seed);
  ServerProcess steady;
  for (int i = 0; i < Times(); ++i) {
    ServerProcess dying;
    const Client client = Client::Connect({.target = dying.address() + "," + steady.address()}).value();
    const int last = static_cast<int>(random() % 12);
    const CollectedSweep answer = Collect(client.Sweep(MixedSweep(kPoints)), [&](int chunk) {
      if (chunk == last) kill(dying.pid(), GetParam());
    });
    EXPECT_TRUE(answer == undisturbed) << "seed " << seed << ", time " << i << ", chunk " << last;
  }
}

TEST(Resume, GoesOnWithTheOnlyServerWhenItIsBack) {
  const CollectedSweep undisturbed = Collect(LocalSolver().Sweep(MixedSweep(kPoints)));
  auto server = std::make_unique<ServerProcess>();
  const std::string address = server->address();
  const Client client = Client::Connect({.target = address}).value();
  const CollectedSweep answer = Collect(client.Sweep(MixedSweep(kPoints)), [&](int chunk) {
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
    const auto response = client.Solve({.scene = MixedSweep(1).grid.scene, .history_at_n_s = {}});
    EXPECT_TRUE(response.ok()) << response.status();
  }
}

}  // namespace
}  // namespace ricochet
