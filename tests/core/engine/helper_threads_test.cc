// HelperThreads: so many helps at once and no more, on threads of their own, and none is lost at the end.

#include "core/engine/helper_threads.h"

#include <gtest/gtest.h>

#include <atomic>
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

}  // namespace
}  // namespace ricochet
