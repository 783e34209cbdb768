// HelperThreads: so many helps at once and no more, on threads of their own, and none is lost at the end.

#include "core/engine/helper_threads.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <future>
#include <mutex>
#include <set>
#include <thread>

namespace ricochet {
namespace {

TEST(HelperThreadsTest, AHelpRunsOnAnotherThreadAndNeverGivesWay) {
  HelperThreads threads(1);
  std::promise<std::thread::id> helped;
  std::atomic<bool> gave_way = true;
  ASSERT_TRUE(threads.Start([&](absl::FunctionRef<bool()> gives_way) {
    gave_way = gives_way();
    helped.set_value(std::this_thread::get_id());
  }));
  EXPECT_NE(helped.get_future().get(), std::this_thread::get_id());
  EXPECT_FALSE(gave_way);
}

TEST(HelperThreadsTest, NoMoreHelpsRunAtOnceThanThereAreThreads) {
  HelperThreads threads(2);
  EXPECT_EQ(threads.most(), 2);
  std::promise<void> end;
  const std::shared_future<void> ended = end.get_future().share();
  const auto help = [ended](absl::FunctionRef<bool()> /*gives_way*/) { ended.wait(); };
  EXPECT_TRUE(threads.Start(help));
  EXPECT_TRUE(threads.Start(help));
  EXPECT_FALSE(threads.Start(help));
  end.set_value();
  while (!threads.Start(help)) std::this_thread::yield();
}

TEST(HelperThreadsTest, WithoutThreadsNobodyHelps) {
  HelperThreads threads(0);
  EXPECT_FALSE(threads.Start([](absl::FunctionRef<bool()> /*gives_way*/) { FAIL(); }));
}

TEST(HelperThreadsTest, AThreadServesAgain) {
  HelperThreads threads(1);
  std::mutex mutex;
  std::set<std::thread::id> ids;
  for (int i = 0; i < 100; ++i) {
    const auto help = [&](absl::FunctionRef<bool()> /*gives_way*/) {
      const std::lock_guard lock(mutex);
      ids.insert(std::this_thread::get_id());
    };
    while (!threads.Start(help)) std::this_thread::yield();
  }
  while (!threads.Start([](absl::FunctionRef<bool()> /*gives_way*/) {})) std::this_thread::yield();
  const std::lock_guard lock(mutex);
  EXPECT_EQ(ids.size(), 1U);
}

TEST(HelperThreadsTest, EveryHelpThatWasAcceptedEndsBeforeTheThreadsDo) {
  std::atomic<int> accepted = 0;
  std::atomic<int> ended = 0;
  {
    HelperThreads threads(3);
    for (int i = 0; i < 1000; ++i) {
      if (threads.Start([&](absl::FunctionRef<bool()> /*gives_way*/) { ++ended; })) ++accepted;
    }
  }
  EXPECT_GT(accepted, 0);
  EXPECT_EQ(ended, accepted);
}

TEST(HelperThreadsDeathTest, AForkedProcessNeitherUsesThemNorWaitsForThem) {
  auto* const threads = new HelperThreads(1);
  std::promise<void> helped;
  ASSERT_TRUE(threads->Start([&](absl::FunctionRef<bool()> /*gives_way*/) { helped.set_value(); }));
  helped.get_future().wait();
  const auto leave = [threads] {
    alarm(30);
    const bool has_started = threads->Start([](absl::FunctionRef<bool()> /*gives_way*/) {});
    delete threads;
    _exit(has_started ? 1 : 0);
  };
  EXPECT_EXIT(leave(), testing::ExitedWithCode(0), "");
  delete threads;
}

TEST(HelperThreadsDeathTest, CoresAreThoseThatTheProcessMayUse) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto count = [] {
    cpu_set_t cores;
    sched_getaffinity(0, sizeof(cores), &cores);
    size_t first = 0;
    while (!CPU_ISSET(first, &cores)) ++first;
    CPU_ZERO(&cores);
    CPU_SET(first, &cores);
    sched_setaffinity(0, sizeof(cores), &cores);
    std::exit(AvailableCores());
  };
  EXPECT_EXIT(count(), testing::ExitedWithCode(1), "");
}

}  // namespace
}  // namespace ricochet
