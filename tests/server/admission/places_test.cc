#include "server/admission/places.h"

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

constexpr PlaceLimits kLimits = {.calls = 4, .calls_per_peer = 3, .streams = 2, .streams_per_peer = 1};

TEST(Places, RefusesAboveTheLimitWithReasonAndRetryDelay) {
  Places places({.calls = 2, .calls_per_peer = 2, .streams = 2, .streams_per_peer = 2});
  const auto first = places.Enter("a", false);
  const auto second = places.Enter("a", true);
  const auto third = places.Enter("b", false);
  EXPECT_TRUE(first.ok() && second.ok());
  EXPECT_EQ(third.status().code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(ReasonOf(third.status()), ErrorReason::kTooManyCalls);
  EXPECT_EQ(RetryDelayOf(third.status()), std::chrono::seconds(1));
  EXPECT_EQ(places.live(), 2);
}

TEST(Places, OnePeerLeavesPlacesToOthers) {
  Places places(kLimits);
  std::vector<absl::StatusOr<Places::Place>> held;
  for (int i = 0; i < 3; ++i) held.push_back(places.Enter("greedy", false));
  EXPECT_TRUE(held.back().ok());
  const auto fourth = places.Enter("greedy", false);
  EXPECT_EQ(ReasonOf(fourth.status()), ErrorReason::kTooManyCalls);
  EXPECT_THAT(std::string(fourth.status().message()), testing::HasSubstr("this client is at its limit of 3"));
  EXPECT_TRUE(places.Enter("other", false).ok());
}

TEST(Places, StreamsLeavePlacesToUnaryCalls) {
  Places places(kLimits);
  const auto first = places.Enter("a", true);
  EXPECT_FALSE(places.Enter("a", true).ok()) << "a has a stream";
  const auto second = places.Enter("b", true);
  EXPECT_TRUE(second.ok());
  EXPECT_FALSE(places.Enter("c", true).ok()) << "there are two streams";
  EXPECT_TRUE(places.Enter("a", false).ok());
}

TEST(Places, PlaceIsFreeOnceItIsGivenBack) {
  Places places({.calls = 1});
  std::optional<absl::StatusOr<Places::Place>> place = places.Enter("a", true);
  ASSERT_FALSE(places.Enter("a", true).ok());
  place.reset();
  EXPECT_TRUE(places.Enter("a", true).ok());
  EXPECT_EQ(places.live(), 0);
}

TEST(Places, MovedPlaceIsOne) {
  Places places({.calls = 1});
  auto place = places.Enter("a", false);
  ASSERT_TRUE(place.ok());
  const Places::Place moved = *std::move(place);
  EXPECT_EQ(places.live(), 1);
}

TEST(Places, LimitHoldsUnderManyThreads) {
  constexpr int kLimit = 3;
  Places places({.calls = kLimit, .calls_per_peer = kLimit, .streams = kLimit, .streams_per_peer = kLimit});
  std::atomic<int> inside = 0;
  std::atomic<int> most = 0;
  const auto work = [&] {
    for (int i = 0; i < 20'000; ++i) {
      const auto place = places.Enter("a", false);
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
  EXPECT_EQ(places.live(), 0);
}

TEST(Places, EveryUsualLimitAdmitsACall) {
  for (const int calls : {1, 2, 7, 8, 1024}) {
    const PlaceLimits usual = PlacesFor(calls);
    EXPECT_GE(usual.calls_per_peer, 1);
    EXPECT_GE(usual.streams_per_peer, 1);
    EXPECT_LE(usual.streams, usual.calls);
  }
  EXPECT_EQ(PlacesFor(1024),
            (PlaceLimits{.calls = 1024, .calls_per_peer = 896, .streams = 256, .streams_per_peer = 192}));
}

}  // namespace
}  // namespace ricochet::server
