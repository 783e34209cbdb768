#include "server/admission/watchdog.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/processes/eventually.h"

namespace ricochet::server {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;

TEST(WatchdogTest, ReportsEachChangeOnce) {
  std::mutex mutex;
  std::vector<std::string> reports;
  std::atomic<bool> good = true;
  std::atomic<int> checks = 0;
  const auto check = [&](const std::stop_token&) {
    ++checks;
    return good ? absl::OkStatus() : absl::UnavailableError("stuck");
  };
  const auto report = [&](const absl::Status& status) {
    const std::lock_guard lock(mutex);
    reports.emplace_back(status.ok() ? "good" : status.message());
  };
  const std::jthread watchdog = StartWatchdog(milliseconds(1), check, report);
  const auto wait_for_checks = [&checks] {
    const int before = checks;
    EXPECT_TRUE(Eventually([&] { return checks >= before + 3; }));
  };
  wait_for_checks();
  good = false;
  wait_for_checks();
  good = true;
  wait_for_checks();
  const std::lock_guard lock(mutex);
  EXPECT_THAT(reports, ElementsAre("stuck", "good"));
}

TEST(WatchdogTest, EndsWithoutAReportWhileACheckOrAPauseLasts) {
  std::atomic<bool> checking = false;
  bool reported = false;
  {
    const std::jthread watchdog = StartWatchdog(
        milliseconds(1),
        [&](const std::stop_token& stop) {
          checking = true;
          while (!stop.stop_requested()) std::this_thread::yield();
          return absl::UnavailableError("too late");
        },
        [&](const absl::Status&) { reported = true; });
    ASSERT_TRUE(Eventually([&] { return checking.load(); }));
  }
  EXPECT_FALSE(reported);
  const std::jthread pausing = StartWatchdog(
      std::chrono::hours(1), [](const std::stop_token&) { return absl::OkStatus(); }, [](const absl::Status&) {});
}

}  // namespace
}  // namespace ricochet::server
