#include "server/telemetry/call_rule.h"

#include <gtest/gtest.h>

#include <chrono>

namespace ricochet::server {
namespace {

using std::chrono::milliseconds;

const CallSampler::Clock::time_point kStart = CallSampler::Clock::time_point() + std::chrono::hours(1);

CallRecord CallWith(absl::StatusCode status, double duration_s = 0.0) {
  CallRecord call;
  call.status = status;
  call.duration_s = duration_s;
  return call;
}

// Returns how many of `calls` successful calls at a time get a line.
int Taken(CallSampler& sampler, int calls, CallSampler::Clock::time_point now) {
  int taken = 0;
  for (int i = 0; i < calls; ++i) taken += sampler.Take(CallWith(absl::StatusCode::kOk), now).has_value() ? 1 : 0;
  return taken;
}

TEST(CallRule, GoodRulesAreRead) {
  EXPECT_EQ(ParseCallRule("all")->kind, CallRule::Kind::kAll);
  EXPECT_EQ(ParseCallRule("errors")->kind, CallRule::Kind::kErrors);
  EXPECT_EQ(ParseCallRule("slow:0.25"), (CallRule{.kind = CallRule::Kind::kSlow, .slow = milliseconds(250)}));
  EXPECT_EQ(ParseCallRule("sample:1000"), (CallRule{.kind = CallRule::Kind::kSample, .count = 1000}));
  EXPECT_EQ(ParseCallRule("rate:7"), (CallRule{.kind = CallRule::Kind::kRate, .count = 7}));
}

TEST(CallRule, BadRulesAreRefused) {
  for (const char* text : {"", "none", "slow", "slow:", "slow:-1", "slow:nan", "slow:3601", "sample:0", "sample:1.5",
                           "rate:-1", "rate:", "rate:10x", "ALL"}) {
    EXPECT_FALSE(ParseCallRule(text).has_value()) << text;
  }
}

TEST(CallSampler, AFailedCallIsAlwaysTaken) {
  for (const char* rule : {"all", "errors", "slow:10", "sample:1000", "rate:1"}) {
    CallSampler sampler(*ParseCallRule(rule));
    Taken(sampler, 5, kStart);
    EXPECT_TRUE(sampler.Take(CallWith(absl::StatusCode::kInternal), kStart).has_value()) << rule;
  }
}

TEST(CallSampler, ARateIsKeptInEachSecond) {
  CallSampler sampler(*ParseCallRule("rate:3"));
  EXPECT_EQ(Taken(sampler, 10, kStart), 3);
  EXPECT_EQ(Taken(sampler, 10, kStart + milliseconds(999)), 0);
  EXPECT_EQ(Taken(sampler, 10, kStart + milliseconds(1000)), 3);
}

TEST(CallSampler, ASampleIsTheFirstOfEachGroup) {
  CallSampler sampler(*ParseCallRule("sample:4"));
  EXPECT_EQ(Taken(sampler, 1, kStart), 1);
  EXPECT_EQ(Taken(sampler, 3, kStart), 0);
  EXPECT_EQ(Taken(sampler, 1, kStart), 1);
}

TEST(CallSampler, SlowCallsAreTaken) {
  CallSampler sampler(*ParseCallRule("slow:0.5"));
  EXPECT_FALSE(sampler.Take(CallWith(absl::StatusCode::kOk, 0.499), kStart).has_value());
  EXPECT_TRUE(sampler.Take(CallWith(absl::StatusCode::kOk, 0.5), kStart).has_value());
}

TEST(CallSampler, ACallThatIsTakenTellsHowManyWereLeftOutBeforeIt) {
  CallSampler sampler(*ParseCallRule("errors"));
  EXPECT_EQ(Taken(sampler, 6, kStart), 0);
  EXPECT_EQ(sampler.Take(CallWith(absl::StatusCode::kInternal), kStart), 6);
  EXPECT_EQ(sampler.Take(CallWith(absl::StatusCode::kInternal), kStart), 0);
}

}  // namespace
}  // namespace ricochet::server
