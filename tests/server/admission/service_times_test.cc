#include "server/admission/service_times.h"

#include <gtest/gtest.h>

namespace ricochet::server {
namespace {

constexpr RequestCost kOne = {.cause = CostCause::kRows, .octave = 10};
constexpr RequestCost kOther = {.cause = CostCause::kRows, .octave = 11};

TEST(ServiceTimes, NothingIsExpectedOfACallThatIsUnknown) {
  ServiceTimes times;
  times.Learn(kOne, 3.0, false);
  EXPECT_EQ(times.Expected(kOther), 0.0);
}

TEST(ServiceTimes, FirstTimeIsTakenAndLaterOnesMoveTheExpectationTowardsThem) {
  ServiceTimes times;
  times.Learn(kOne, 3.0, false);
  EXPECT_EQ(times.Expected(kOne), 3.0);
  times.Learn(kOne, 1.0, false);
  EXPECT_LT(times.Expected(kOne), 3.0);
  for (int i = 0; i < 100; ++i) times.Learn(kOne, 1.0, false);
  EXPECT_NEAR(times.Expected(kOne), 1.0, 1e-3);
}

TEST(ServiceTimes, CallThatWasCutShortRaisesTheExpectation) {
  ServiceTimes times;
  times.Learn(kOne, 1.0, false);
  times.Learn(kOne, 0.9, true);
  EXPECT_EQ(times.Expected(kOne), 1.8);
  times.Learn(kOne, 0.1, true);
  EXPECT_EQ(times.Expected(kOne), 1.8) << "it says nothing about a call that takes longer";
}

}  // namespace
}  // namespace ricochet::server
