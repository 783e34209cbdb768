// Where lanes say that a pendulum calls for the closed form, ChoosePendulum says the same, also next to the tolerance;
// and they say so of most pendulums with friction.

#include "core/plan/pendulum_models.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <limits>
#include <vector>

#include "core/models/pendulum/columns.h"
#include "core/plan/choose.h"
#include "hwy/targets.h"
#include "tests/support/only_target.h"
#include "tests/support/scenes/plan_scenes.h"

namespace ricochet {
namespace {

using pendulum::Problem;

constexpr size_t kCopies = 9;  // More than a vector of any target here has lanes, so that some are left for doubles.

Model ModelInLanes(const Problem& problem) {
  pendulum::ProblemColumns columns(problem.law, kCopies);
  for (size_t i = 0; i < kCopies; ++i) columns.Set(i, problem);
  std::vector<Model> models(kCopies, Model::kNone);
  const bool all = ModelsOfPendulum(columns, absl::MakeSpan(models));
  for (const Model model : models) EXPECT_EQ(model, models.front());
  EXPECT_EQ(all, models.front() == Model::kPendulum);
  return models.front();
}

TEST(PendulumModelsTest, AreThoseOfTheChoice) {
  PlanScenes scenes(1);
  constexpr int kProblems = 10'000;
  int found = 0;
  for (int i = 0; i < kProblems && !HasFailure(); ++i) {
    const Problem problem = scenes.Pendulum();
    const Model model = ModelInLanes(problem);
    ASSERT_TRUE(model == Model::kPendulum || model == Model::kUnspecified);
    if (model != Model::kPendulum) continue;
    ++found;
    for (const double tolerance : {0.0, 1e-12, 1e-6, 1e-2, 0.1}) {
      EXPECT_EQ(ChoosePendulum(problem, {}, {.relative_tolerance = tolerance}).model, Model::kPendulum) << i;
    }
  }
  std::printf("%d of %d closed forms found\n", found, kProblems);
  EXPECT_GT(found, kProblems / 3);
}

TEST(PendulumModelsTest, AreTheSameOnEverySimdTarget) {
  std::vector<Model> first;
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    const OnlyTarget only(target);
    PlanScenes scenes(2);
    std::vector<Model> models;
    for (int i = 0; i < 2000; ++i) models.push_back(ModelInLanes(scenes.Pendulum()));
    if (first.empty()) first = models;
    EXPECT_EQ(models, first) << target;
  }
}

TEST(PendulumModelsTest, LeaveOpenWhatIsNotSurelyValid) {
  const Problem valid = {
      .inertia = 2.0, .a = 0.3, .b = 1.0, .omega_minus = -1.0, .mu = 0.1, .mu_static = 0.1, .coefficient = 0.5};
  ASSERT_EQ(ModelInLanes(valid), Model::kPendulum);
  const auto expect_open = [&](double Problem::*number, double value) {
    Problem problem = valid;
    problem.*number = value;
    EXPECT_EQ(ModelInLanes(problem), Model::kUnspecified) << value;
  };
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  for (const auto number : {&Problem::inertia, &Problem::a, &Problem::b, &Problem::omega_minus, &Problem::mu,
                            &Problem::mu_static, &Problem::coefficient}) {
    for (const double value : {kNaN, 0.0, std::numeric_limits<double>::infinity(), 0x1p101, 0x1p-101}) {
      expect_open(number, value);
    }
  }
  for (const auto number : {&Problem::inertia, &Problem::a, &Problem::mu, &Problem::coefficient}) {
    expect_open(number, -0.2);
  }
  expect_open(&Problem::omega_minus, 1.0);
  expect_open(&Problem::mu_static, 0.05);
  expect_open(&Problem::coefficient, 1.5);
}

}  // namespace
}  // namespace ricochet
