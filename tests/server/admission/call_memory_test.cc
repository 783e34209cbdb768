// What requests and answers hold is limited in all and for each peer, and is given back.

#include "server/admission/call_memory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "ricochet/error.h"

namespace ricochet::server {
namespace {

using testing::HasSubstr;

constexpr int64_t kMiB = int64_t{1} << 20;

absl::StatusOr<CallMemory::Hold> Take(CallMemory& memory, const std::string& peer, int64_t bytes) {
  return memory.Take([&peer] { return peer; }, bytes);
}

TEST(CallMemory, RefusesAPeerAboveThreeQuartersAndAllAboveTheLimit) {
  CallMemory memory(8 * kMiB);
  const auto most = Take(memory, "greedy", 6 * kMiB);
  ASSERT_TRUE(most.ok());
  const absl::Status of_peer = Take(memory, "greedy", kMiB).status();
  EXPECT_EQ(of_peer.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(ReasonOf(of_peer), ErrorReason::kTooManyCalls);
  EXPECT_EQ(RetryDelayOf(of_peer), std::chrono::seconds(1));
  EXPECT_THAT(std::string(of_peer.message()), HasSubstr("of this client's calls hold 6 MiB, its limit"));
  const auto other = Take(memory, "other", 2 * kMiB);
  ASSERT_TRUE(other.ok());
  EXPECT_EQ(memory.held(), 8 * kMiB);
  const absl::Status of_all = Take(memory, "third", kMiB).status();
  EXPECT_EQ(RetryDelayOf(of_all), std::chrono::seconds(1));
  EXPECT_THAT(std::string(of_all.message()), HasSubstr("the 8 MiB that the server has for them"));
}

TEST(CallMemory, TakesBackWhatIsNoLongerHeld) {
  CallMemory memory(8 * kMiB);
  auto held = Take(memory, "a", 6 * kMiB);
  ASSERT_TRUE(held.ok());
  *held = CallMemory::Hold();
  EXPECT_EQ(memory.held(), 0);
  EXPECT_TRUE(Take(memory, "a", 6 * kMiB).ok());
  EXPECT_EQ(memory.held(), 0) << "the hold of an expression ends with it";
}

TEST(CallMemory, LetsAMessageAboveTheLimitThroughAlone) {
  CallMemory memory(8 * kMiB);
  {
    const auto large = Take(memory, "a", 100 * kMiB);
    ASSERT_TRUE(large.ok());
    EXPECT_FALSE(Take(memory, "b", kMiB).ok());
  }
  const auto small = Take(memory, "a", kMiB);
  EXPECT_FALSE(Take(memory, "b", 100 * kMiB).ok());
  EXPECT_TRUE(Take(memory, "b", 7 * kMiB).ok()) << "more than the share of a peer, but the first of this one";
}

TEST(CallMemory, DoesNotCountSmallMessages) {
  CallMemory memory(kMiB);
  const auto small = memory.Take([]() -> std::string { throw "nobody asks who it is"; }, CallMemory::kUncounted - 1);
  ASSERT_TRUE(small.ok());
  EXPECT_EQ(memory.held(), 0);
}

TEST(CallMemory, CountsRightWhenManyThreadsTake) {
  CallMemory memory(4 * kMiB);
  std::atomic<int> taken = 0;
  std::atomic<int> refused = 0;
  std::atomic<int> too_much = 0;
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([&memory, &taken, &refused, &too_much, t] {
      for (int i = 0; i < 2000; ++i) {
        const auto hold = Take(memory, std::to_string(t % 3), kMiB + i);
        ++(hold.ok() ? taken : refused);
        if (memory.held() > 4 * kMiB) ++too_much;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(taken + refused, 16'000);
  EXPECT_EQ(too_much, 0);
  EXPECT_EQ(memory.held(), 0);
}

}  // namespace
}  // namespace ricochet::server
