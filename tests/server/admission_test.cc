#include "server/admission.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "ricochet/error.h"

namespace ricochet::server {
namespace {

TEST(Admission, RefusesAboveTheLimitWithReasonAndRetryDelay) {
  Admission admission(2);
  const auto first = admission.Enter();
  const auto second = admission.Enter();
  const auto third = admission.Enter();
  EXPECT_TRUE(first.ok() && second.ok());
  EXPECT_EQ(third.status().code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(ReasonOf(third.status()), ErrorReason::kTooManyCalls);
  EXPECT_EQ(RetryDelayOf(third.status()), std::chrono::seconds(1));
  EXPECT_EQ(admission.live(), 2);
}

TEST(Admission, PlaceIsFreeOnceItsTicketIsGone) {
  Admission admission(1);
  std::optional<absl::StatusOr<Admission::Ticket>> ticket = admission.Enter();
  ASSERT_FALSE(admission.Enter().ok());
  ticket.reset();
  EXPECT_TRUE(admission.Enter().ok());
  EXPECT_EQ(admission.live(), 0);
}

TEST(Admission, MovedTicketHoldsOnePlace) {
  Admission admission(1);
  auto ticket = admission.Enter();
  ASSERT_TRUE(ticket.ok());
  const Admission::Ticket moved = *std::move(ticket);
  EXPECT_EQ(admission.live(), 1);
}

TEST(Admission, LimitHoldsUnderManyThreads) {
  constexpr int kLimit = 3;
  Admission admission(kLimit);
  std::atomic<int> inside = 0;
  std::atomic<int> most = 0;
  const auto work = [&] {
    for (int i = 0; i < 20'000; ++i) {
      const auto ticket = admission.Enter();
      if (!ticket.ok()) continue;
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
  EXPECT_EQ(admission.live(), 0);
}

}  // namespace
}  // namespace ricochet::server
