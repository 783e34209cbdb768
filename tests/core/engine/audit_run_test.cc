// Batches of audits that other threads help have the reports and the summary of those that nobody helps, and end soon.

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <memory>
#include <thread>

#include "core/engine/row_runs.h"
#include "tests/support/processes/counted_threads.h"
#include "tests/support/processes/eventually.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet {
namespace {

bool Never() { return false; }

// Velocities after the impact that keep and break limits and, every hundred rows, one that is not finite.
AuditBatchRequest Audits(const System& system, size_t rows) {
  AuditBatchRequest request = {.scene = With(system)};
  const bool in_space = std::holds_alternative<SpatialContact>(system);
  for (size_t i = 0; i < rows; ++i) {
    const double share = static_cast<double>(i % 37) / 37.0;
    request.columns.tangential_after_m_s.push_back(0.2 + 0.8 * share);
    if (in_space) request.columns.tangential_2_after_m_s.push_back(0.6 * share);
    request.columns.normal_after_m_s.push_back(i % 100 == 99 ? std::nan("") : 1.5 * share - 0.1);
  }
  request.columns.velocity_uncertainty_m_s = {1e-3};
  return request;
}

TEST(AuditRunTest, ReportsAndSummaryAreTheSameWhateverTheNumberOfThreads) {
  int helped = 0;
  for (const System& system : {System(Contact()), System(ContactInSpace())}) {
    const AuditBatchRequest request = Audits(system, 4000);
    const auto alone = RunAudits(request, nullptr, Never);
    ASSERT_TRUE(alone.ok()) << alone.status();
    EXPECT_EQ(alone->summary.invalid, (Tally{40, 99}));
    for (const int helpers : {1, 7}) {
      const auto threads = std::make_shared<CountedThreads>(helpers);
      const auto together = RunAudits(request, threads, Never);
      ASSERT_TRUE(together.ok()) << together.status();
      EXPECT_EQ(*together, *alone) << system.index() << " with " << helpers;
      helped += threads->started();
    }
  }
  EXPECT_GT(helped, 0);
}

// On a busy machine the caller may have audited all rows before a helper comes back, so that the rows become more.
TEST(AuditRunTest, HelpersMayGiveWayAfterEachPiece) {
  int started = 0;
  constexpr int kMostAttempts = 100;
  for (int i = 0; started <= 2 && i < kMostAttempts && !HasFailure(); ++i) {
    const AuditBatchRequest request = Audits(ContactInSpace(), 8000);
    const auto threads = std::make_shared<CountedThreads>(2, true);
    EXPECT_EQ(*RunAudits(request, threads, Never), *RunAudits(request, nullptr, Never));
    started = threads->started();
  }
  EXPECT_GT(started, 2);
}

TEST(AuditRunTest, AStopEndsHelpersToo) {
  const auto threads = std::make_shared<CountedThreads>(3);
  const auto stopped = [&] { return threads->started() > 0; };
  EXPECT_EQ(RunAudits(Audits(ContactInSpace(), 8000), threads, stopped).status().code(), absl::StatusCode::kCancelled);
  EXPECT_TRUE(Eventually([&] { return threads->running() == 0; }));
}

TEST(AuditRunTest, ADeadlineEndsABatchOfManyThreads) {
  const auto in_a_moment = std::chrono::steady_clock::now() + std::chrono::milliseconds(3);
  const auto late =
      LocalSolver(Limits::None(), 4).AuditBatch(Audits(ContactInSpace(), 8000), {.deadline = in_a_moment});
  EXPECT_EQ(late.status().code(), absl::StatusCode::kDeadlineExceeded) << late.status();
}

// The options say that the engine asks is_stopped on the thread of the call.
TEST(AuditRunTest, TheOptionsAreAskedOnTheThreadOfTheCallAlone) {
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<bool> asked_elsewhere = false;
  const CallOptions options = {.is_stopped = [&] {
    if (std::this_thread::get_id() != caller) asked_elsewhere = true;
    return false;
  }};
  EXPECT_TRUE(LocalSolver(Limits::None(), 3).AuditBatch(Audits(ContactInSpace(), 2000), options).ok());
  EXPECT_FALSE(asked_elsewhere);
}

}  // namespace
}  // namespace ricochet
