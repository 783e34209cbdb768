// The gate with real threads: how many compute at once, in which order, and who is turned away without computing.

#include "server/admission/gate.h"

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
constexpr RequestCost kDear = {.cause = CostCause::kCertificate, .octave = 10};

Turn TurnOf(const std::string& peer, std::optional<RequestCost> cost) {
  return {.peer = peer, .deadline = {}, .is_gone = [] { return false; }, .cost = cost};
}

// Work that holds a slot until it is released.
class Holder {
 public:
  Holder(Gate& gate, std::optional<RequestCost> cost)
      : thread_([this, &gate, cost] {
          EXPECT_TRUE(gate.Compute(TurnOf("holder", cost),
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

class GateTest : public testing::Test {
 protected:
  // Starts a call that adds its name to the order in which calls compute.
  void Start(const std::string& name, Turn turn) {
    const size_t before = gate_.waiting();
    threads_.emplace_back([this, name, turn] {
      const absl::Status status = gate_.Compute(turn, [&] {
        const std::lock_guard lock(mutex_);
        order_.push_back(name);
      });
      if (!status.ok()) turned_away_.push_back(name);
    });
    EXPECT_TRUE(Eventually([&] { return gate_.waiting() > before; })) << name << " does not wait";
  }

  std::stop_source drain_;
  Gate gate_{1, 3, drain_.get_token()};
  std::mutex mutex_;
  std::vector<std::string> order_;
  std::vector<std::string> turned_away_;
  std::vector<std::jthread> threads_;
};

TEST_F(GateTest, AsManyComputeAtOnceAsThereAreThreads) {
  std::stop_source drain;
  Gate gate(2, 1000, drain.get_token());
  std::atomic<int> now = 0;
  std::atomic<int> most = 0;
  std::atomic<int> done = 0;
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 40; ++i) {
      threads.emplace_back([&, i] {
        ASSERT_TRUE(gate.Compute(TurnOf(std::to_string(i % 3), kDear),
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

TEST_F(GateTest, PeersTakeTurnsAndDeadlinesOrderTheCallsOfOne) {
  {
    Holder holder(gate_, kDear);
    Turn late = TurnOf("a", kDear);
    late.deadline = steady_clock::now() + seconds(200);
    Turn soon = late;
    soon.deadline = steady_clock::now() + seconds(100);
    Start("a late", late);
    Start("a soon", soon);
    Start("b", TurnOf("b", kDear));
  }
  threads_.clear();
  EXPECT_THAT(order_, ElementsAre("a soon", "b", "a late"));
}

TEST_F(GateTest, PartsOfStreamsTakeTurnsWhateverTheirDeadlines) {
  {
    Holder holder(gate_, std::nullopt);
    Turn late = TurnOf("a", std::nullopt);
    late.deadline = steady_clock::now() + seconds(200);
    Turn soon = late;
    soon.deadline = steady_clock::now() + seconds(100);
    Start("late", late);
    Start("soon", soon);
  }
  threads_.clear();
  EXPECT_THAT(order_, ElementsAre("late", "soon"));
}

TEST_F(GateTest, CheapCallsDoNotWaitForDearOnesOrStreams) {
  Holder dear(gate_, kDear);
  Holder stream(gate_, std::nullopt);
  bool computed = false;
  EXPECT_TRUE(gate_.Compute(TurnOf("a", kCheap), [&computed] { computed = true; }).ok());
  EXPECT_TRUE(computed);
}

TEST_F(GateTest, DearWorkRunsAtALowerPriorityAndStreamsAtTheLowest) {
  const auto nice = [this](std::optional<RequestCost> cost) {
    int value = 0;
    EXPECT_TRUE(gate_.Compute(TurnOf("a", cost), [&value] { value = getpriority(PRIO_PROCESS, 0); }).ok());
    return value;
  };
  const int own = getpriority(PRIO_PROCESS, 0);
  EXPECT_EQ(nice(kCheap), own);
  EXPECT_GT(nice(kDear), own);
  EXPECT_GT(nice(std::nullopt), nice(kDear));
}

TEST_F(GateTest, CallWhoseDeadlinePassesWhileItWaitsIsNeverComputed) {
  Holder holder(gate_, kDear);
  Turn turn = TurnOf("a", kDear);
  turn.deadline = steady_clock::now() + milliseconds(30);
  bool computed = false;
  EXPECT_EQ(gate_.Compute(turn, [&computed] { computed = true; }).code(), absl::StatusCode::kDeadlineExceeded);
  EXPECT_FALSE(computed);
  EXPECT_EQ(gate_.waiting(), 0U);
}

TEST_F(GateTest, CallWhoseDeadlineHasPassedIsNeverComputed) {
  for (const RequestCost& cost : {kCheap, kDear}) {
    Turn turn = TurnOf("a", cost);
    turn.deadline = steady_clock::now() - milliseconds(1);
    EXPECT_EQ(gate_.Compute(turn, [] { FAIL() << "it was computed"; }).code(), absl::StatusCode::kDeadlineExceeded);
  }
}

TEST_F(GateTest, CallWhoseCallerHasGoneIsNeverComputed) {
  std::atomic<bool> gone = false;
  Turn turn = TurnOf("a", kDear);
  turn.is_gone = [&gone] { return gone.load(); };
  Holder holder(gate_, kDear);
  std::future<absl::Status> ended =
      std::async(std::launch::async, [&] { return gate_.Compute(turn, [] { FAIL() << "it was computed"; }); });
  EXPECT_TRUE(Eventually([this] { return gate_.waiting() == 1; }));
  gone = true;
  EXPECT_EQ(ended.get().code(), absl::StatusCode::kCancelled) << "it need not wait for its turn";
  holder.Release();
  EXPECT_EQ(gate_.Compute(turn, [] { FAIL() << "it was computed"; }).code(), absl::StatusCode::kCancelled);
}

TEST_F(GateTest, CallAboveTheBoundOfTheQueueIsRefusedAtOnceWithARetryDelay) {
  {
    Holder holder(gate_, kDear);
    for (int i = 0; i < 3; ++i) Start("a", TurnOf("a", kDear));
    const absl::Status refused = gate_.Compute(TurnOf("a", kDear), [] { FAIL() << "it was computed"; });
    EXPECT_EQ(refused.code(), absl::StatusCode::kResourceExhausted);
    EXPECT_EQ(ReasonOf(refused), ErrorReason::kOverloaded);
    EXPECT_TRUE(RetryDelayOf(refused).has_value());
  }
  threads_.clear();
  EXPECT_EQ(order_.size(), 3U);
}

TEST_F(GateTest, CallThatWouldWaitBeyondItsDeadlineIsRefusedAtOnce) {
  constexpr int kWaiting = 40;
  Gate gate(1, kWaiting + 1, drain_.get_token());
  // The gate learns that such a call takes 250 ms at least, so that those that wait are expected to take 10 s. The
  // deadline is far away on the clock of any machine that runs this test.
  ASSERT_TRUE(gate.Compute(TurnOf("a", kDear), [] { std::this_thread::sleep_for(milliseconds(250)); }).ok());
  Turn hurried = TurnOf("b", kDear);
  {
    std::vector<std::jthread> waiting;
    Holder holder(gate, kDear);
    for (int i = 0; i < kWaiting; ++i) {
      waiting.emplace_back([&gate, i] { EXPECT_TRUE(gate.Compute(TurnOf(std::to_string(i), kDear), [] {}).ok()); });
    }
    ASSERT_TRUE(Eventually([&gate] { return gate.waiting() == kWaiting; }));
    hurried.deadline = steady_clock::now() + seconds(8);
    EXPECT_EQ(ReasonOf(gate.Compute(hurried, [] { FAIL() << "it was computed"; })), ErrorReason::kOverloaded);
    EXPECT_EQ(gate.waiting(), kWaiting) << "it was refused at once, and waited for none of them";
  }
  // Without a wait it is computed, however long such calls are expected to take.
  hurried.deadline = steady_clock::now() + seconds(60);
  EXPECT_TRUE(gate.Compute(hurried, [] {}).ok());
}

TEST_F(GateTest, ADrainTurnsAwayCallsThatWaitAndNewOnes) {
  Holder holder(gate_, kDear);
  std::future<absl::Status> waits = std::async(
      std::launch::async, [this] { return gate_.Compute(TurnOf("a", kDear), [] { FAIL() << "it was computed"; }); });
  EXPECT_TRUE(Eventually([this] { return gate_.waiting() == 1; }));
  drain_.request_stop();
  EXPECT_EQ(ReasonOf(waits.get()), ErrorReason::kDraining);
  for (const RequestCost& cost : {kCheap, kDear}) {
    EXPECT_EQ(ReasonOf(gate_.Compute(TurnOf("a", cost), [] { FAIL() << "it was computed"; })), ErrorReason::kDraining);
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

TEST_F(GateTest, AHelperComputesAtTheLowestPriorityInASlotThatNoCallWants) {
  std::stop_source drain;
  Gate gate(2, 10, drain.get_token());
  const std::shared_ptr<Helpers> helpers = gate.HelpersFor("a");
  EXPECT_EQ(helpers->most(), 1);
  const Holder stream(gate, std::nullopt);
  EndlessHelp help;
  ASSERT_TRUE(help.StartIn(*helpers));
  EXPECT_TRUE(Eventually([&] { return help.helps(); }));
  EXPECT_GT(help.nice(), getpriority(PRIO_PROCESS, 0));
  EXPECT_EQ(gate.computing(), 2U);
  EndlessHelp another;
  EXPECT_FALSE(another.StartIn(*helpers));
}

TEST_F(GateTest, AHelperGivesWayToEveryOtherCall) {
  for (const std::optional<RequestCost> cost : {std::optional<RequestCost>(), std::optional<RequestCost>(kDear)}) {
    std::stop_source drain;
    Gate gate(2, 10, drain.get_token());
    const std::shared_ptr<Helpers> helpers = gate.HelpersFor("a");
    const Holder stream(gate, std::nullopt);
    EndlessHelp help;
    ASSERT_TRUE(help.StartIn(*helpers));
    EXPECT_TRUE(Eventually([&] { return help.helps(); }));
    const Holder call(gate, cost);
    EXPECT_TRUE(Eventually([&] { return !help.helps(); }));
    EXPECT_TRUE(Eventually([&] { return gate.computing() == 2; }));
    EXPECT_FALSE(help.StartIn(*helpers));
  }
}

TEST_F(GateTest, NoHelperStartsOnceADrainHas) {
  std::stop_source drain;
  Gate gate(2, 10, drain.get_token());
  drain.request_stop();
  EndlessHelp help;
  EXPECT_FALSE(help.StartIn(*gate.HelpersFor("a")));
}

TEST_F(GateTest, ExceptionIsPassedOnAndItsSlotIsFree) {
  for (const RequestCost& cost : {kCheap, kDear}) {
    EXPECT_THROW(gate_.Compute(TurnOf("a", cost), [] { throw std::bad_alloc(); }).IgnoreError(), std::bad_alloc);
    EXPECT_TRUE(gate_.Compute(TurnOf("a", cost), [] {}).ok());
  }
  EXPECT_EQ(gate_.computing(), 0U);
}

}  // namespace
}  // namespace ricochet::server
