// Numbers of scenes that can be worked out by hand, and of springs that an independent implementation computed at 34
// digits.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/support/scenes/multi_contact_scenes.h"

namespace ricochet {
namespace {

const AttainedOutcome* OutcomeOf(const MultiContactAnswer& answer, const std::string& order) {
  for (const AttainedOutcome& outcome : answer.orders) {
    for (const std::string& text : outcome.orders) {
      if (text == order) return &outcome;
    }
  }
  ADD_FAILURE() << "no order " << order;
  return nullptr;
}

// The x velocities of balls in a row.
std::vector<double> BallVelocities(const AttainedOutcome& outcome) {
  std::vector<double> velocities;
  for (size_t i = 0; i < outcome.velocity.size(); i += 3) velocities.push_back(outcome.velocity[i]);
  return velocities;
}

void ExpectNear(const std::vector<double>& found, const std::vector<double>& expected, double most) {
  ASSERT_EQ(found.size(), expected.size());
  for (size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], most) << i;
}

// Unfolding the wedge of angle theta: the two orders agree exactly if theta is pi/m.
TEST(KnownNumbersTest, ElasticBallsWithMassesOneTwoOneEndInTwoWays) {
  const MultiContactAnswer answer = AnswerTo({.scene = RowOfBalls({1, 2, 1}, {1, 0, -1}, {1, 1})});
  const AttainedOutcome* const first = OutcomeOf(answer, "1-2-1");
  const AttainedOutcome* const second = OutcomeOf(answer, "2-1-2");
  ASSERT_TRUE(first != nullptr && second != nullptr);
  ExpectNear(first->contact_velocity_m_s, {0, 1.0 / 9, 0, 43.0 / 27}, 1e-15);
  ExpectNear(second->contact_velocity_m_s, {0, 43.0 / 27, 0, 1.0 / 9}, 1e-15);
  EXPECT_EQ(answer.verdict, MultiContactVerdict::kOrderMatters);
  EXPECT_EQ(answer.pairs.front().divisor, std::nullopt);
}

TEST(KnownNumbersTest, ElasticBallsWithMassesOneThreeOneEndInTwoWays) {
  const MultiContactAnswer answer = AnswerTo({.scene = RowOfBalls({1, 3, 1}, {1, 0, -1}, {1, 1})});
  const AttainedOutcome* const first = OutcomeOf(answer, "1-2");
  ASSERT_NE(first, nullptr);
  ExpectNear(first->contact_velocity_m_s, {0, 0.25, 0, 1.5}, 1e-15);
  EXPECT_EQ(answer.verdict, MultiContactVerdict::kOrderMatters);
}

TEST(KnownNumbersTest, EqualElasticBallsEndInOneWayBecauseTheirAngleIsAThirdOfPi) {
  const MultiContactAnswer answer = AnswerTo({.scene = RowOfBalls({1, 1, 1}, {1, 0, -1}, {1, 1})});
  ASSERT_EQ(answer.orders.size(), 1U);
  EXPECT_EQ(answer.orders.front().orders, (std::vector<std::string>{"1-2-1", "2-1-2"}));
  ExpectNear(answer.orders.front().contact_velocity_m_s, {0, 1, 0, 1}, 1e-15);
  EXPECT_EQ(answer.pairs.front().divisor, 3);
  EXPECT_EQ(answer.verdict, MultiContactVerdict::kOrdersAgree);
}

// The threshold is e = 7 - 4 sqrt(3) for equal balls, and e2 = 1/3 for c = 1/2 and e1 = 0.
TEST(KnownNumbersTest, EqualBallsStrikeWithoutEndUpToTheThreshold) {
  const auto ends_by = [](double e1, double e2) {
    return AnswerTo({.scene = RowOfBalls({1, 1, 1}, {1, 0, 0}, {e1, e2}), .methods = {MultiContactMethod::kOrders}})
        .orders.front()
        .end;
  };
  EXPECT_EQ(ends_by(0.0717967, 0.0717967), MultiContactEnd::kEndless);
  EXPECT_NE(ends_by(0.0717969, 0.0717969), MultiContactEnd::kEndless);
  EXPECT_EQ(ends_by(0.0, 0.3333333), MultiContactEnd::kEndless);
  EXPECT_NE(ends_by(0.0, 0.3333334), MultiContactEnd::kEndless);
}

TEST(KnownNumbersTest, EqualBallsBelowTheThresholdEndTogether) {
  const MultiContactAnswer answer = AnswerTo({.scene = RowOfBalls({1, 1, 1}, {1, 0, 0}, {0.05, 0.05})});
  ASSERT_EQ(answer.orders.size(), 1U);
  const AttainedOutcome& outcome = answer.orders.front();
  EXPECT_EQ(outcome.orders, std::vector<std::string>{"1-(2-1)"});
  EXPECT_EQ(outcome.end, MultiContactEnd::kEndless);
  EXPECT_TRUE(outcome.error_is_proved);
  ExpectNear(BallVelocities(outcome), {1.0 / 3, 1.0 / 3, 1.0 / 3}, 1e-15);
  EXPECT_NEAR(outcome.impulse_n_s[1], 2.0 / 3, 1e-15);
  EXPECT_NEAR(outcome.impulse_n_s[3], 1.0 / 3, 1e-15);
  // Springs of equal stiffness strike without end, too.
  ExpectNear(BallVelocities(*answer.springs), {1.0 / 3, 1.0 / 3, 1.0 / 3}, 1e-10);
}

TEST(KnownNumbersTest, TheBlockThatStrikesLeftFirst) {
  const MultiContactAnswer plastic = AnswerTo({.scene = FallingBlock(1, 0)});
  const AttainedOutcome* const first = OutcomeOf(plastic, "1-2");
  ASSERT_NE(first, nullptr);
  ExpectNear(first->velocity, {0.21, 0.105, -0.21}, 1e-15);
  ExpectNear(first->impulse_n_s, {0.3, 0.85, -0.09, 0.255}, 1e-15);
  EXPECT_NEAR(plastic.energy_before_j + first->energy_change_j, 147.0 / 4000, 1e-15);
  const MultiContactAnswer half = AnswerTo({.scene = FallingBlock(1, 0.5)});
  const AttainedOutcome* const one = OutcomeOf(half, "1");
  ASSERT_NE(one, nullptr);
  ExpectNear(one->velocity, {0.45, 0.275, -0.45}, 1e-15);
  ExpectNear(one->impulse_n_s, {0.45, 1.275, 0, 0}, 1e-15);
  EXPECT_EQ(half.verdict, MultiContactVerdict::kOrderMatters);
}

TEST(KnownNumbersTest, TheBlockOnSpringsTurnsWithTheRatioOfTheirStiffnesses) {
  struct Case {
    double stiffness, rate, vertical, left, right;
  };
  for (const Case& one : {Case{1, 0, 0.5, 0.75, 0.75},
                          Case{2, 0.1344929607039685, 0.4854296663135503, 0.5521831388261531, 0.9332465274873972},
                          Case{10, 0.3440478078815736, 0.3929433946041815, 0.2090706361365282, 1.183872758467653},
                          Case{100, 0.4333883701506805, 0.3023070239101339, 0.03718665424160285, 1.265120369668531}}) {
    const MultiContactAnswer answer = AnswerTo({.scene = FallingBlock(1, 0.5, one.stiffness)});
    ASSERT_TRUE(answer.springs.has_value());
    const AttainedOutcome& springs = *answer.springs;
    EXPECT_TRUE(springs.error_is_proved);
    EXPECT_NEAR(springs.velocity[2], one.rate, 2e-15) << one.stiffness;
    EXPECT_NEAR(springs.velocity[1], one.vertical, 2e-15) << one.stiffness;
    EXPECT_NEAR(springs.impulse_n_s[1], one.left, 2e-15) << one.stiffness;
    EXPECT_NEAR(springs.impulse_n_s[3], one.right, 2e-15) << one.stiffness;
  }
}

TEST(KnownNumbersTest, WhatTheBlockCanDo) {
  const MultiContactAnswer answer = AnswerTo({.scene = FallingBlock(1, 0.5)});
  const auto expect = [&](const std::string& output, double lower, double upper) {
    for (const PossibleRange& range : answer.possible) {
      if (range.output != output) continue;
      EXPECT_NEAR(range.lower, lower, 1e-12) << output;
      EXPECT_NEAR(range.upper, upper, 1e-12) << output;
    }
  };
  expect("body_1.rate", -std::sqrt(1.5), std::sqrt(1.5));
  expect("body_1.y", 0, 1);
  expect("body_1.x", -0.883095189484, 0.883095189484);
  expect("contact_1.t", -std::sqrt(2.5), std::sqrt(2.5));
  EXPECT_EQ(answer.possible.size(), 7U);
}

TEST(KnownNumbersTest, ThreeBallsOnSprings) {
  const auto velocities = [](double e) {
    return BallVelocities(*AnswerTo({.scene = RowOfBalls({1, 1, 1}, {1, 0, 0}, {e, e})}).springs);
  };
  ExpectNear(velocities(1.0), {-0.130261695064521, 0.1502295694347741, 0.980032125629747}, 2e-15);
  ExpectNear(velocities(0.5), {0.1827348569165253, 0.2339841796460748, 0.5832809634373999}, 2e-15);
  ExpectNear(velocities(0.2), {0.3009255158228119, 0.3197538707551939, 0.3793206134219942}, 2e-15);
}

TEST(KnownNumbersTest, WhatThreeBallsCanDo) {
  const MultiContactAnswer answer = AnswerTo({.scene = RowOfBalls({1, 1, 1}, {1, 0, 0}, {1, 1})});
  const double expected[3][2] = {{-1.0 / 3, 1.0 / 3}, {0, 2.0 / 3}, {1.0 / 3, 1}};
  for (const PossibleRange& range : answer.possible) {
    for (int ball = 0; ball < 3; ++ball) {
      if (range.output != "body_" + std::to_string(ball + 1) + ".x") continue;
      EXPECT_NEAR(range.lower, expected[ball][0], 1e-12);
      EXPECT_NEAR(range.upper, expected[ball][1], 1e-12);
    }
  }
}

TEST(KnownNumbersTest, FiveBallsOnSprings) {
  const MultiContactAnswer answer = AnswerTo({.scene = RowOfBalls({1, 1, 1, 1, 1}, {1, 0, 0, 0, 0}, {1, 1, 1, 1})});
  ExpectNear(BallVelocities(*answer.springs),
             {-0.1322794847097077, -0.07532916980256641, -0.03101082901402906, 0.2962177501414387, 0.9424017333848645},
             3e-15);
  EXPECT_EQ(answer.orders.front().orders, std::vector<std::string>{"1-2-3-4"});
  EXPECT_EQ(answer.verdict, MultiContactVerdict::kOrdersAgreeSpringsDiffer);
}

// Balls at (2, 0) m/s that touch each other and a wall. Every order gives (-2, 0); an engine was seen to double the
// energy (github.com/keenon/nimblephysics, issue 143).
TEST(KnownNumbersTest, TwoBallsAndAWallKeepTheirEnergy) {
  MultiContactScene scene = RowOfBalls({1, 1}, {2, 0}, {1});
  scene.contacts.push_back({.energetic = 1.0, .body = 2, .point_m = {1.5, 0.0}, .normal = {-1.0, 0.0}});
  const MultiContactAnswer answer = AnswerTo({.scene = scene});
  for (const AttainedOutcome& outcome : answer.orders) ExpectNear(BallVelocities(outcome), {-2, 0}, 1e-15);
  ExpectNear(BallVelocities(*answer.springs), {-1.953857, -0.427132}, 5e-7);
  EXPECT_NEAR(answer.springs->energy_change_j, 0.0, answer.springs->work_error_j);
}

}  // namespace
}  // namespace ricochet
