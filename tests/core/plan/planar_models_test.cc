// The models that lanes give are those of ChoosePlanar, also where a size or an error lies next to the tolerance, and
// few contacts are left open.

#include "core/plan/planar_models.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <limits>
#include <vector>

#include "core/models/sliding/sliding.h"
#include "core/plan/choose.h"
#include "core/plan/scene_problem.h"
#include "core/plan/sizes.h"
#include "hwy/targets.h"
#include "tests/support/only_target.h"
#include "tests/support/scenes/plan_scenes.h"
#include "tests/support/scenes/planar_scenes.h"
#include "tests/support/scenes/solved_in_lanes.h"

namespace ricochet {
namespace {

using planar::PlanarColumnsOfLaw;

constexpr size_t kCopies = 9;  // More than a vector of any target here has lanes, so that some are left for doubles.

// The model of the contact in every place of a call.
Model ModelInLanes(const PlanarProblem& problem, double tolerance) {
  PlanarColumnsOfLaw columns = {.law = problem.law};
  for (size_t i = 0; i < kCopies; ++i) columns.Add(problem);
  std::vector<Model> models(kCopies);
  ModelsOfPlanar(columns.Columns(), tolerance, absl::MakeSpan(models));
  for (const Model model : models) EXPECT_EQ(model, models.front());
  return models.front();
}

Model ModelAlone(const PlanarProblem& problem, double tolerance) {
  return ChoosePlanar(problem, {}, {.relative_tolerance = tolerance}).model;
}

// Tolerances at and around every size and error that the choice compares with one.
std::vector<double> CriticalTolerances(const PlanarProblem& problem) {
  std::vector<double> tolerances = {0.0, 1e-12, 1e-6, 1e-2};
  if (problem.v0 >= 0.0) return tolerances;
  const Sizes sizes = PlanarSizes(problem, {});
  const double stop = sizes[Effect::kSlipStop].value;
  const double frictionless = sliding::FrictionlessErrorsOf(SlidingProblemOf(problem)).Largest();
  const double sliding = problem.u0 == 0.0 ? 0.0 : sliding::ErrorsOf(SlidingProblemOf(problem)).Largest();
  for (const double size :
       {sizes[Effect::kFriction].value, stop, stop + sizes[Effect::kStaticFriction].value, frictionless, sliding}) {
    for (const double nearby : {-0.5, -0x1p-17, -0x1p-30, -0x1p-52, 0.0, 0x1p-52, 0x1p-30, 0x1p-17, 1.0}) {
      const double tolerance = size * (1.0 + nearby);
      if (tolerance <= 0.1) tolerances.push_back(tolerance);
    }
  }
  return tolerances;
}

template <typename Next>
double ShareLeftOpen(int count, const Next& next) {
  int asked = 0;
  int open = 0;
  for (int i = 0; i < count; ++i) {
    const PlanarProblem problem = next();
    for (const double tolerance : CriticalTolerances(problem)) {
      const Model model = ModelInLanes(problem, tolerance);
      ++asked;
      open += model == Model::kUnspecified ? 1 : 0;
      if (model == Model::kUnspecified) continue;
      EXPECT_EQ(model, ModelAlone(problem, tolerance))
          << "tolerance " << tolerance << ", u0 " << problem.u0 << ", mu " << problem.mu;
    }
  }
  return static_cast<double>(open) / asked;
}

TEST(PlanarModelsTest, AreThoseOfTheChoiceAtCriticalTolerances) {
  PlanScenes scenes(1);
  const double of_many_scales = ShareLeftOpen(4000, [&] { return scenes.Planar(); });
  planar::SceneSource source(2);
  const double of_thresholds = ShareLeftOpen(4000, [&] { return source.Any(); });
  std::printf("left open: %.2f and %.2f of all\n", of_many_scales, of_thresholds);
  EXPECT_LT(of_many_scales, 0.9);
  EXPECT_LT(of_thresholds, 0.9);
}

TEST(PlanarModelsTest, AreFoundForNearlyAllEverydayContacts) {
  planar::SceneSource source(3);
  for (const double tolerance : {0.0, 1e-12, 1e-6}) {
    int open = 0;
    constexpr int kContacts = 20'000;
    for (int i = 0; i < kContacts && !HasFailure(); ++i) {
      const PlanarProblem problem = source.Everyday();
      const Model model = ModelInLanes(problem, tolerance);
      if (model == Model::kUnspecified) {
        ++open;
      } else {
        EXPECT_EQ(model, ModelAlone(problem, tolerance));
      }
    }
    EXPECT_LT(open, kContacts / 20) << tolerance;
    std::printf("tolerance %.0e: %d of %d left open\n", tolerance, open, kContacts);
  }
}

TEST(PlanarModelsTest, AreTheSameOnEverySimdTarget) {
  planar::SceneSource source(4);
  std::vector<PlanarProblem> problems;
  for (int i = 0; i < 500; ++i) problems.push_back(source.Any());
  std::vector<Model> first;
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    const OnlyTarget only(target);
    std::vector<Model> models;
    for (const PlanarProblem& problem : problems) models.push_back(ModelInLanes(problem, 1e-12));
    if (first.empty()) first = models;
    EXPECT_EQ(models, first) << target;
  }
}

TEST(PlanarModelsTest, LeaveOpenWhatIsNotSurelyValid) {
  const PlanarProblem valid = {
      .w = {3.0, 0.5, 1.0}, .u0 = 0.3, .v0 = -1.0, .mu = 0.4, .mu_static = 0.4, .coefficient = 0.5};
  ASSERT_EQ(ModelInLanes(valid, 1e-12), Model::kPlanar);
  const auto expect_open = [&](double PlanarProblem::*number, double value) {
    PlanarProblem problem = valid;
    problem.*number = value;
    EXPECT_EQ(ModelInLanes(problem, 1e-12), Model::kUnspecified) << value;
  };
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  for (const auto number : {&PlanarProblem::u0, &PlanarProblem::v0, &PlanarProblem::mu, &PlanarProblem::mu_static,
                            &PlanarProblem::coefficient}) {
    expect_open(number, kNaN);
    expect_open(number, std::numeric_limits<double>::infinity());
    expect_open(number, 0x1p101);
    expect_open(number, 0x1p-101);
  }
  expect_open(&PlanarProblem::mu, -0.1);
  expect_open(&PlanarProblem::mu_static, 0.39);
  expect_open(&PlanarProblem::coefficient, 1.01);
  for (const auto entry : {&PlanarDelassus::tt, &PlanarDelassus::tn, &PlanarDelassus::nn}) {
    for (const double value : {kNaN, -2.0, 0x1p101}) {
      PlanarProblem problem = valid;
      problem.w.*entry = value;
      EXPECT_EQ(ModelInLanes(problem, 1e-12), Model::kUnspecified) << value;
    }
  }
}

}  // namespace
}  // namespace ricochet
