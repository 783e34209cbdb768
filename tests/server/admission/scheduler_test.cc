// The scheduler with real threads: how many compute at once, in which order, and who is turned away without computing.

#include "server/admission/scheduler.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <mutex>
#include <new>
#include <string>
#include <thread>
#include <vector>

#include "ricochet/error.h"
#include "tests/support/processes/eventually.h"

namespace ricochet::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;
using testing::ElementsAre;

constexpr RequestCost kCheap = {};
constexpr RequestCost kExpensive = {.cause = CostCause::kCertificate, .octave = 10};

ComputeRequest TurnOf(const std::string& peer, std::optional<RequestCost> cost) {
  return {.peer = peer, .deadline = {}, .is_gone = [] { return false; }, .cost = cost};
}

// Work that holds a slot until it is released.
class Holder {
 public:
  Holder(Scheduler& scheduler, std::optional<RequestCost> cost)
      : thread_([this, &scheduler, cost] {
          EXPECT_TRUE(scheduler
                          .Compute(TurnOf("holder", cost),
                                   [this] {
                                     started_.set_value();
                                     release_.get_future().wait();
                                   })
                          .ok());
        }) {
    started_.get_future().wait();
  }
  ~Holder() { Release(); }
  void Release() {
    if (!released_) release_.set_value();
    released_ = true;
  }

 private:
  std::promise<void> started_;
  std::promise<void> release_;
  bool released_ = false;
  std::jthread thread_;
};

class SchedulerTest : public testing::Test {
 protected:
  // Starts a call that adds its name to the order in which calls compute.
  void Start(const std::string& name, ComputeRequest turn) {
    const size_t before = scheduler_.waiting();
    threads_.emplace_back([this, name, turn] {
      const absl::Status status = scheduler_.Compute(turn, [&] {
        const std::lock_guard lock(mutex_);
        order_.push_back(name);
      });
      if (!status.ok()) turned_away_.push_back(name);
    });
    EXPECT_TRUE(Eventually([&] { return scheduler_.waiting() > before; })) << name << " does not wait";
  }

  std::stop_source drain_;
  Scheduler scheduler_{1, 3, drain_.get_token()};
  std::mutex mutex_;
  std::vector<std::string> order_;
  std::vector<std::string> turned_away_;
  std::vector<std::jthread> threads_;
};

TEST_F(SchedulerTest, AsManyComputeAtOnceAsThereAreThreads) {
  std::stop_source drain;
  Scheduler scheduler(2, 1000, drain.get_token());
  std::atomic<int> now = 0;
  std::atomic<int> most = 0;
  std::atomic<int> done = 0;
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 40; ++i) {
      threads.emplace_back([&, i] {
        ASSERT_TRUE(scheduler
                        .Compute(TurnOf(std::to_string(i % 3), kExpensive),
                                 [&] {
                                   const int inside = ++now;
                                   int seen = most;
                                   while (inside > seen && !most.compare_exchange_weak(seen, inside)) {
                                   }
                                   std::this_thread::sleep_for(milliseconds(2));
                                   --now;
                                   ++done;
                                 })
                        .ok());
      });
    }
  }
  EXPECT_EQ(done, 40);
  EXPECT_EQ(most, 2);
}

TEST_F(SchedulerTest, PeersTakeTurnsAndDeadlinesOrderTheCallsOfOne) {
  {
    Holder holder(scheduler_, kExpensive);
    ComputeRequest late = TurnOf("a", kExpensive);
    late.deadline = steady_clock::now() + seconds(200);
    ComputeRequest soon = late;
    soon.deadline = steady_clock::now() + seconds(100);
    Start("a late", late);
    Start("a soon", soon);
    Start("b", TurnOf("b", kExpensive));
  }
  threads_.clear();
  EXPECT_THAT(order_, ElementsAre("a soon", "b", "a late"));
}

TEST_F(SchedulerTest, PartsOfStreamsTakeTurnsWhateverTheirDeadlines) {
  {
    Holder holder(scheduler_, std::nullopt);
    ComputeRequest late = TurnOf("a", std::nullopt);
    late.deadline = steady_clock::now() + seconds(200);
    ComputeRequest soon = late;
    soon.deadline = steady_clock::now() + seconds(100);
    Start("late", late);
    Start("soon", soon);
  }
  threads_.clear();
  EXPECT_THAT(order_, ElementsAre("late", "soon"));
}

TEST_F(SchedulerTest, CheapCallsDoNotWaitForDearOnesOrStreams) {
  Holder expensive(scheduler_, kExpensive);
  Holder stream(scheduler_, std::nullopt);
  bool computed = false;
  EXPECT_TRUE(scheduler_.Compute(TurnOf("a", kCheap), [&computed] { computed = true; }).ok());
  EXPECT_TRUE(computed);
}

TEST_F(SchedulerTest, DearWorkRunsAtALowerPriorityAndStreamsAtTheLowest) {
  const auto nice = [this](std::optional<RequestCost> cost) {
    int value = 0;
    EXPECT_TRUE(scheduler_.Compute(TurnOf("a", cost), [&value] { value = getpriority(PRIO_PROCESS, 0); }).ok());
    return value;
  };
  const int own = getpriority(PRIO_PROCESS, 0);
  EXPECT_EQ(nice(kCheap), own);
  EXPECT_GT(nice(kExpensive), own);
  EXPECT_GT(nice(std::nullopt), nice(kExpensive));
}

TEST_F(SchedulerTest, CallWhoseDeadlinePassesWhileItWaitsIsNeverComputed) {
  Holder holder(scheduler_, kExpensive);
  ComputeRequest turn = TurnOf("a", kExpensive);
  turn.deadline = steady_clock::now() + milliseconds(30);
  bool computed = false;
  EXPECT_EQ(scheduler_.Compute(turn, [&computed] { computed = true; }).code(), absl::StatusCode::kDeadlineExceeded);
  EXPECT_FALSE(computed);
  EXPECT_EQ(scheduler_.waiting(), 0U);
}

// A stream has sent chunks before the part that its deadline ends.
TEST_F(SchedulerTest, PartOfAStreamDoesNotSayThatTheCallNeverBegan) {
  ComputeRequest turn = TurnOf("a", std::nullopt);
  turn.deadline = steady_clock::now() - milliseconds(1);
  EXPECT_EQ(scheduler_.Compute(turn, [] { FAIL() << "it was computed"; }),
            absl::DeadlineExceededError("the deadline passed"));
}

TEST_F(SchedulerTest, CallWhoseDeadlineHasPassedIsNeverComputed) {
  for (const RequestCost& cost : {kCheap, kExpensive}) {
    ComputeRequest turn = TurnOf("a", cost);
    turn.deadline = steady_clock::now() - milliseconds(1);
    EXPECT_EQ(scheduler_.Compute(turn, [] { FAIL() << "it was computed"; }).code(),
              absl::StatusCode::kDeadlineExceeded);
  }
}

TEST_F(SchedulerTest, CallWhoseCallerHasGoneIsNeverComputed) {
  std::atomic<bool> gone = false;
  ComputeRequest turn = TurnOf("a", kExpensive);
  turn.is_gone = [&gone] { return gone.load(); };
  Holder holder(scheduler_, kExpensive);
  std::future<absl::Status> ended =
      std::async(std::launch::async, [&] { return scheduler_.Compute(turn, [] { FAIL() << "it was computed"; }); });
  EXPECT_TRUE(Eventually([this] { return scheduler_.waiting() == 1; }));
  gone = true;
  EXPECT_EQ(ended.get().code(), absl::StatusCode::kCancelled) << "it need not wait for its turn";
  holder.Release();
  EXPECT_EQ(scheduler_.Compute(turn, [] { FAIL() << "it was computed"; }).code(), absl::StatusCode::kCancelled);
}

TEST_F(SchedulerTest, CallAboveTheBoundOfTheQueueIsRefusedAtOnceWithARetryDelay) {
  {
    Holder holder(scheduler_, kExpensive);
    for (int i = 0; i < 3; ++i) Start("a", TurnOf("a", kExpensive));
    const absl::Status refused = scheduler_.Compute(TurnOf("a", kExpensive), [] { FAIL() << "it was computed"; });
    EXPECT_EQ(refused.code(), absl::StatusCode::kResourceExhausted);
    EXPECT_EQ(ReasonOf(refused), ErrorReason::kOverloaded);
    EXPECT_TRUE(RetryDelayOf(refused).has_value());
  }
  threads_.clear();
  EXPECT_EQ(order_.size(), 3U);
}

TEST_F(SchedulerTest, CallThatWouldWaitBeyondItsDeadlineIsRefusedAtOnce) {
  constexpr int kWaiting = 40;
  Scheduler scheduler(1, kWaiting + 1, drain_.get_token());
  // The scheduler learns that such a call takes 250 ms at least, so that those that wait are expected to take 10 s. The
  // deadline is far away on the clock of any machine that runs this test.
  ASSERT_TRUE(scheduler.Compute(TurnOf("a", kExpensive), [] { std::this_thread::sleep_for(milliseconds(250)); }).ok());
  ComputeRequest hurried = TurnOf("b", kExpensive);
  {
    std::vector<std::jthread> waiting;
    Holder holder(scheduler, kExpensive);
    for (int i = 0; i < kWaiting; ++i) {
      waiting.emplace_back(
          [&scheduler, i] { EXPECT_TRUE(scheduler.Compute(TurnOf(std::to_string(i), kExpensive), [] {}).ok()); });
    }
    ASSERT_TRUE(Eventually([&scheduler] { return scheduler.waiting() == kWaiting; }));
    hurried.deadline = steady_clock::now() + seconds(8);
    EXPECT_EQ(ReasonOf(scheduler.Compute(hurried, [] { FAIL() << "it was computed"; })), ErrorReason::kOverloaded);
    EXPECT_EQ(scheduler.waiting(), kWaiting) << "it was refused at once, and waited for none of them";
  }
  // Without a wait it is computed, however long such calls are expected to take.
  hurried.deadline = steady_clock::now() + seconds(60);
  EXPECT_TRUE(scheduler.Compute(hurried, [] {}).ok());
}

TEST_F(SchedulerTest, ADrainTurnsAwayCallsThatWaitAndNewOnes) {
  Holder holder(scheduler_, kExpensive);
  std::future<absl::Status> waits = std::async(std::launch::async, [this] {
    return scheduler_.Compute(TurnOf("a", kExpensive), [] { FAIL() << "it was computed"; });
  });
  EXPECT_TRUE(Eventually([this] { return scheduler_.waiting() == 1; }));
  drain_.request_stop();
  EXPECT_EQ(ReasonOf(waits.get()), ErrorReason::kDraining);
  for (const RequestCost& cost : {kCheap, kExpensive}) {
    EXPECT_EQ(ReasonOf(scheduler_.Compute(TurnOf("a", cost), [] { FAIL() << "it was computed"; })),
              ErrorReason::kDraining);
  }
}

// A help that goes on until it is asked to give way.
class EndlessHelp {
 public:
  bool StartIn(Helpers& helpers) {
    return helpers.Start([this](absl::FunctionRef<bool()> gives_way) {
      nice_ = getpriority(PRIO_PROCESS, 0);
      helps_ = true;
      while (!gives_way() && !ended_) std::this_thread::sleep_for(milliseconds(1));
      helps_ = false;
    });
  }
  ~EndlessHelp() {
    ended_ = true;
    EXPECT_TRUE(Eventually([this] { return !helps_; }));
  }
  bool helps() const { return helps_; }
  int nice() const { return nice_; }

 private:
  std::atomic<bool> helps_ = false;
  std::atomic<bool> ended_ = false;
  std::atomic<int> nice_ = 0;
};

TEST_F(SchedulerTest, AHelperComputesAtTheLowestPriorityInASlotThatNoCallWants) {
  std::stop_source drain;
  Scheduler scheduler(2, 10, drain.get_token());
  const std::shared_ptr<Helpers> helpers = scheduler.HelpersFor("a");
  EXPECT_EQ(helpers->most(), 1);
  const Holder stream(scheduler, std::nullopt);
  EndlessHelp help;
  ASSERT_TRUE(help.StartIn(*helpers));
  EXPECT_TRUE(Eventually([&] { return help.helps(); }));
  EXPECT_GT(help.nice(), getpriority(PRIO_PROCESS, 0));
  EXPECT_EQ(scheduler.computing(), 2U);
  EndlessHelp another;
  EXPECT_FALSE(another.StartIn(*helpers));
}

TEST_F(SchedulerTest, AHelperGivesWayToEveryOtherCall) {
  for (const std::optional<RequestCost> cost : {std::optional<RequestCost>(), std::optional<RequestCost>(kExpensive)}) {
    std::stop_source drain;
    Scheduler scheduler(2, 10, drain.get_token());
    const std::shared_ptr<Helpers> helpers = scheduler.HelpersFor("a");
    const Holder stream(scheduler, std::nullopt);
    EndlessHelp help;
    ASSERT_TRUE(help.StartIn(*helpers));
    EXPECT_TRUE(Eventually([&] { return help.helps(); }));
    const Holder call(scheduler, cost);
    EXPECT_TRUE(Eventually([&] { return !help.helps(); }));
    EXPECT_TRUE(Eventually([&] { return scheduler.computing() == 2; }));
    EXPECT_FALSE(help.StartIn(*helpers));
  }
}

TEST_F(SchedulerTest, NoHelperStartsOnceADrainHas) {
  std::stop_source drain;
  Scheduler scheduler(2, 10, drain.get_token());
  drain.request_stop();
  EndlessHelp help;
  EXPECT_FALSE(help.StartIn(*scheduler.HelpersFor("a")));
}

TEST_F(SchedulerTest, ExceptionIsPassedOnAndItsSlotIsFree) {
  for (const RequestCost& cost : {kCheap, kExpensive}) {
    EXPECT_THROW(scheduler_.Compute(TurnOf("a", cost), [] { throw std::bad_alloc(); }).IgnoreError(), std::bad_alloc);
    EXPECT_TRUE(scheduler_.Compute(TurnOf("a", cost), [] {}).ok());
  }
  EXPECT_EQ(scheduler_.computing(), 0U);
}

}  // namespace
}  // namespace ricochet::server
