#include "server/base/refusal_pace.h"

#include <gtest/gtest.h>

#include <chrono>

namespace ricochet::server {
namespace {

using std::chrono::seconds;

const RefusalPace::Time kNow = RefusalPace::Time(seconds(1000));

TEST(RefusalPace, PeerThatGoesOnWaitsForItsRefusals) {
  RefusalPace pace;
  for (int i = 0; i < RefusalPace::kAtOnce; ++i) EXPECT_EQ(pace.Next("a", kNow), kNow);
  for (int i = 1; i <= 5; ++i) EXPECT_EQ(pace.Next("a", kNow), kNow + i * RefusalPace::kBetween);
}

TEST(RefusalPace, OtherPeersAndLaterRefusalsDoNotWait) {
  RefusalPace pace;
  for (int i = 0; i < 1000; ++i) pace.Next("a", kNow);
  EXPECT_EQ(pace.Next("b", kNow), kNow);
  const RefusalPace::Time later = kNow + 1001 * RefusalPace::kBetween;
  EXPECT_EQ(pace.Next("a", later), later);
}

}  // namespace
}  // namespace ricochet::server
