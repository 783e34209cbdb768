#include "ricochet/error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

namespace ricochet {
namespace {

using testing::HasSubstr;

TEST(ErrorTest, ViolationSpellsTheValueShortestAndStatesTheRule) {
  const Violation violation = MakeViolation("friction.kinetic_coefficient", -0.1, "be >= 0");
  EXPECT_EQ(violation.field, "friction.kinetic_coefficient");
  EXPECT_EQ(violation.description, "= -0.1: must be >= 0");
}

TEST(ErrorTest, InvalidRequestCarriesEveryViolationInMessageAndAsData) {
  const std::vector<Violation> violations = {{"pendulum.a_m", "= 0: must be > 0"},
                                             {"columns[3]", "= \"x; y\": must be"}};
  const absl::Status status = InvalidRequest(violations);
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(ReasonOf(status), ErrorReason::kInvalidRequest);
  EXPECT_EQ(ViolationsOf(status), violations);
  EXPECT_THAT(std::string(status.message()), HasSubstr("pendulum.a_m = 0: must be > 0; columns[3]"));
}

TEST(ErrorTest, OverflowIsOutOfRangeAndNamesTheOutput) {
  const absl::Status status = OutputOverflow("outcome.energy_change_j");
  EXPECT_EQ(status.code(), absl::StatusCode::kOutOfRange);
  EXPECT_EQ(ReasonOf(status), ErrorReason::kOutputOverflow);
  EXPECT_THAT(std::string(status.message()), HasSubstr("outcome.energy_change_j"));
}

TEST(ErrorTest, RetryDelayIsKeptBesideTheReason) {
  absl::Status status = MakeError(absl::StatusCode::kResourceExhausted, ErrorReason::kTooManyCalls, "busy");
  EXPECT_FALSE(RetryDelayOf(status).has_value());
  SetRetryDelay(std::chrono::milliseconds(250), status);
  EXPECT_EQ(RetryDelayOf(status), std::chrono::milliseconds(250));
  EXPECT_EQ(ReasonOf(status), ErrorReason::kTooManyCalls);
}

TEST(ErrorTest, AStatusOfOthersHasNeitherReasonNorViolations) {
  const absl::Status status = absl::InvalidArgumentError("not ours");
  EXPECT_EQ(ReasonOf(status), ErrorReason::kUnspecified);
  EXPECT_TRUE(ViolationsOf(status).empty());
  EXPECT_EQ(ReasonOf(absl::OkStatus()), ErrorReason::kUnspecified);
}

}  // namespace
}  // namespace ricochet
