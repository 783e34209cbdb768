#include "server/admission/live_calls.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "ricochet/error.h"

namespace ricochet::server {
namespace {

constexpr LiveCallLimits kLimits = {.calls = 4, .calls_per_peer = 3, .streams = 2, .streams_per_peer = 1};

TEST(LiveCalls, RefusesAboveTheLimitWithReasonAndRetryDelay) {
  LiveCalls live_calls({.calls = 2, .calls_per_peer = 2, .streams = 2, .streams_per_peer = 2});
  const auto first = live_calls.Enter("a", false);
  const auto second = live_calls.Enter("a", true);
  const auto third = live_calls.Enter("b", false);
  EXPECT_TRUE(first.ok() && second.ok());
  EXPECT_EQ(third.status().code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(ReasonOf(third.status()), ErrorReason::kTooManyCalls);
  EXPECT_EQ(RetryDelayOf(third.status()), std::chrono::seconds(1));
  EXPECT_EQ(live_calls.live(), 2);
}

TEST(LiveCalls, OnePeerLeavesPlacesToOthers) {
  LiveCalls live_calls(kLimits);
  std::vector<absl::StatusOr<LiveCalls::Permit>> held;
  for (int i = 0; i < 3; ++i) held.push_back(live_calls.Enter("greedy", false));
  EXPECT_TRUE(held.back().ok());
  const auto fourth = live_calls.Enter("greedy", false);
  EXPECT_EQ(ReasonOf(fourth.status()), ErrorReason::kTooManyCalls);
  EXPECT_THAT(std::string(fourth.status().message()), testing::HasSubstr("this client is at its limit of 3"));
  EXPECT_TRUE(live_calls.Enter("other", false).ok());
}

TEST(LiveCalls, StreamsLeavePlacesToUnaryCalls) {
  LiveCalls live_calls(kLimits);
  const auto first = live_calls.Enter("a", true);
  EXPECT_FALSE(live_calls.Enter("a", true).ok()) << "a has a stream";
  const auto second = live_calls.Enter("b", true);
  EXPECT_TRUE(second.ok());
  EXPECT_FALSE(live_calls.Enter("c", true).ok()) << "there are two streams";
  EXPECT_TRUE(live_calls.Enter("a", false).ok());
}

TEST(LiveCalls, PlaceIsFreeOnceItIsGivenBack) {
  LiveCalls live_calls({.calls = 1});
  std::optional<absl::StatusOr<LiveCalls::Permit>> place = live_calls.Enter("a", true);
  ASSERT_FALSE(live_calls.Enter("a", true).ok());
  place.reset();
  EXPECT_TRUE(live_calls.Enter("a", true).ok());
  EXPECT_EQ(live_calls.live(), 0);
}

TEST(LiveCalls, MovedPlaceIsOne) {
  LiveCalls live_calls({.calls = 1});
  auto place = live_calls.Enter("a", false);
  ASSERT_TRUE(place.ok());
  const LiveCalls::Permit moved = *std::move(place);
  EXPECT_EQ(live_calls.live(), 1);
}

TEST(LiveCalls, LimitHoldsUnderManyThreads) {
  constexpr int kLimit = 3;
  LiveCalls live_calls({.calls = kLimit, .calls_per_peer = kLimit, .streams = kLimit, .streams_per_peer = kLimit});
  std::atomic<int> inside = 0;
  std::atomic<int> most = 0;
  const auto work = [&] {
    for (int i = 0; i < 20'000; ++i) {
      const auto place = live_calls.Enter("a", false);
      if (!place.ok()) continue;
      int seen = most;
      const int now = ++inside;
      while (now > seen && !most.compare_exchange_weak(seen, now)) {
      }
      --inside;
    }
  };
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 8; ++i) threads.emplace_back(work);
  }
  EXPECT_LE(most, kLimit);
  EXPECT_GE(most, 1);
  EXPECT_EQ(live_calls.live(), 0);
}

TEST(LiveCalls, EveryDefaultLimitAdmitsACall) {
  for (const int calls : {1, 2, 7, 8, 1024}) {
    const LiveCallLimits defaults = LiveCallLimitsFor(calls);
    EXPECT_GE(defaults.calls_per_peer, 1);
    EXPECT_GE(defaults.streams_per_peer, 1);
    EXPECT_LE(defaults.streams, defaults.calls);
  }
  EXPECT_EQ(LiveCallLimitsFor(1024),
            (LiveCallLimits{.calls = 1024, .calls_per_peer = 896, .streams = 256, .streams_per_peer = 192}));
}

}  // namespace
}  // namespace ricochet::server
