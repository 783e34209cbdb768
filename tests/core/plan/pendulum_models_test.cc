// Where lanes say that a pendulum calls for the closed form, ChoosePendulum says the same, also next to the tolerance; and
// they say so of most pendulums with friction.

#include "core/plan/pendulum_models.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <vector>

#include "core/models/pendulum/columns.h"
#include "core/plan/choose.h"
#include "core/plan/sizes.h"
#include "hwy/targets.h"
#include "tests/support/only_target.h"
#include "tests/support/plan_scenes.h"

namespace ricochet {
namespace {

using pendulum::Problem;

constexpr size_t kCopies = 9;  // More than a vector of any target here has lanes, so that some are left for doubles.

Model ModelInLanes(const Problem& problem, double tolerance) {
  pendulum::ProblemColumns columns(problem.law, kCopies);
  for (size_t i = 0; i < kCopies; ++i) columns.Set(i, problem);
  std::vector<Model> models(kCopies, Model::kNone);
  const bool all = ModelsOfPendulum(columns, tolerance, absl::MakeSpan(models));
  for (const Model model : models) EXPECT_EQ(model, models.front());
  EXPECT_EQ(all, models.front() == Model::kPendulum);
  return models.front();
}

std::vector<double> CriticalTolerances(const Problem& problem) {
  std::vector<double> tolerances = {0.0, 1e-12, 1e-6, 1e-2};
  for (const double size : {PendulumFrictionSize(problem).value, PendulumHigherOrderSize(problem).value}) {
    for (const double factor : {0.1, 0.24, 0.25, 0.26, 0.5, 0.999, 1.001, 2.0}) {
      if (factor * size <= 0.1) tolerances.push_back(factor * size);
    }
  }
  return tolerances;
}

TEST(PendulumModelsTest, AreThoseOfTheChoiceAtCriticalTolerances) {
  PlanScenes scenes(1);
  int asked = 0;
  int found = 0;
  int wanted = 0;
  for (int i = 0; i < 10'000; ++i) {
    const Problem problem = scenes.Pendulum();
    for (const double tolerance : CriticalTolerances(problem)) {
      const Model model = ModelInLanes(problem, tolerance);
      ASSERT_TRUE(model == Model::kPendulum || model == Model::kUnspecified);
      const Model alone = ChoosePendulum(problem, {}, {.relative_tolerance = tolerance}).model;
      ++asked;
      found += model == Model::kPendulum ? 1 : 0;
      wanted += alone == Model::kPendulum ? 1 : 0;
      if (model != Model::kPendulum) continue;
      EXPECT_EQ(alone, Model::kPendulum) << "scene " << i << ", tolerance " << tolerance;
    }
  }
  std::printf("%d of %d closed forms found, of %d\n", found, wanted, asked);
  EXPECT_GT(found, wanted / 3);
  EXPECT_LT(wanted, asked);
}

TEST(PendulumModelsTest, AreTheSameOnEverySimdTarget) {
  std::vector<Model> first;
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    const OnlyTarget only(target);
    PlanScenes scenes(2);
    std::vector<Model> models;
    for (int i = 0; i < 2000; ++i) models.push_back(ModelInLanes(scenes.Pendulum(), 1e-6));
    if (first.empty()) first = models;
    EXPECT_EQ(models, first) << target;
  }
}

TEST(PendulumModelsTest, LeaveOpenWhatIsNotSurelyValid) {
  const Problem valid = {
      .inertia = 2.0, .a = 0.3, .b = 1.0, .omega_minus = -1.0, .mu = 0.1, .mu_static = 0.1, .coefficient = 0.5};
  ASSERT_EQ(ModelInLanes(valid, 1e-12), Model::kPendulum);
  const auto expect_open = [&](double Problem::*number, double value) {
    Problem problem = valid;
    problem.*number = value;
    EXPECT_EQ(ModelInLanes(problem, 1e-12), Model::kUnspecified) << value;
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
