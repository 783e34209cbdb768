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

TEST(ErrorTest, TwentyViolationsAreListedAndTheLastSaysThatThereAreMore) {
  std::vector<Violation> violations;
  for (int i = 0; i < 20; ++i) violations.push_back({"columns[" + std::to_string(i) + "]", "= \"x\": must be"});
  EXPECT_EQ(ViolationsOf(InvalidRequest(violations)), violations);
  EXPECT_FALSE(IsFull(violations));
  violations.push_back({"end_index", "= -1: must be"});
  EXPECT_TRUE(IsFull(violations));
  const absl::Status status = InvalidRequest(violations);
  const std::vector<Violation> listed = ViolationsOf(status);
  ASSERT_EQ(listed.size(), 20);
  EXPECT_EQ(listed[18], violations[18]);
  EXPECT_EQ(listed[19].description, violations[19].description + " (and more violations)");
  EXPECT_THAT(std::string(status.message()), testing::Not(HasSubstr("end_index")));
}

TEST(ErrorTest, ALimitIsResourceExhaustedAndNamesTheField) {
  const std::vector<Violation> violations = {{"linkage.links", "has 65 entries: must have at most 64"}};
  const absl::Status status = LimitExceeded(violations);
  EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(ReasonOf(status), ErrorReason::kLimitExceeded);
  EXPECT_EQ(ViolationsOf(status), violations);
  EXPECT_FALSE(RetryDelayOf(status).has_value());
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
