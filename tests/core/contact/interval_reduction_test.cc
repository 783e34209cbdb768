// Reductions of boxes: they contain the reduction of every scene of the box.

#include "core/contact/interval_reduction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <variant>
#include <vector>

#include "core/contact/reduction.h"
#include "core/scene/numbers.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet {
namespace {

double Uniform(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

std::vector<double*> NumbersOf(Scene& scene) {
  std::vector<double*> numbers;
  VisitNumbers(scene,
               [&](const NumberPath& /*path*/, double& number, NumberRule /*rule*/) { numbers.push_back(&number); });
  return numbers;
}

// The systems in the plane, W of full rank, with a moving surface where there may be one.
std::vector<Scene> Scenes() {
  std::vector<Scene> scenes;
  for (const System& system : Systems()) {
    if (TangentialDirections(system) == 1) scenes.push_back(With(system));
  }
  scenes.push_back(With(
      Linkage{{{0.7, 1.0, 0.4, 0.1, -0.3, 1.0}, {1.0, 2.0, 0.5, 0.2, 1.1, -2.0}, {0.4, 0.5, 0.1, 0.1, 2.0, 0.5}}}));
  for (Scene& scene : scenes) {
    if (!std::holds_alternative<BodyPair>(scene.system)) scene.surface_velocity = SurfaceVelocity{{0.3}, -0.1};
  }
  return scenes;
}

// A mass matrix stays symmetric.
void Mirror(Scene& scene) {
  auto* const mechanism = std::get_if<Mechanism>(&scene.system);
  if (mechanism == nullptr) return;
  const size_t n = mechanism->rates.size();
  for (size_t i = 0; i < n * n; ++i) mechanism->mass_matrix[i % n * n + i / n] = mechanism->mass_matrix[i];
}

// `count` numbers of the scene, drawn at random, get ranges.
SceneBox RandomBox(const Scene& scene, int count, double relative, std::mt19937_64& random) {
  SceneBox box = {scene, scene, std::nullopt};
  const std::vector<double*> low = NumbersOf(box.low);
  const std::vector<double*> high = NumbersOf(box.high);
  for (int k = 0; k < count; ++k) {
    const size_t i = random() % low.size();
    const double reach = relative * std::fabs(*low[i]);
    *low[i] -= reach;
    *high[i] += reach;
  }
  Mirror(box.low);
  Mirror(box.high);
  return box;
}

Scene Inside(SceneBox box, std::mt19937_64& random) {
  const std::vector<double*> low = NumbersOf(box.low);
  const std::vector<double*> high = NumbersOf(box.high);
  for (size_t i = 0; i < low.size(); ++i) *low[i] = Uniform(random, *low[i], *high[i]);
  Mirror(box.low);
  return box.low;
}

void ExpectHolds(const AffineInterval& form, double value, double scale, double ulps) {
  const double slack = ulps * 0x1p-52 * scale;
  EXPECT_GE(value, form.range().lower - slack);
  EXPECT_LE(value, form.range().upper + slack);
}

// Up to the rounding of the sample's own reduction.
void ExpectHolds(const AffineContact& form, const PlanarReduction& sample) {
  const auto& [tt, tn, nn] = sample.w;
  const double speed = 10.0;
  ExpectHolds(form.wtt, tt, tt, 64.0);
  ExpectHolds(form.wtn, tn, std::sqrt(tt * nn), 64.0);
  ExpectHolds(form.wnn, nn, nn, 64.0);
  ExpectHolds(form.stick_slope, nn - tn * tn / tt, nn, 256.0);
  ExpectHolds(form.u0, sample.u0[0], speed, 8.0);
  ExpectHolds(form.v0, sample.v0, speed, 8.0);
}

TEST(IntervalReductionTest, HoldsTheContactOfEverySceneOfTheBox) {
  std::mt19937_64 random(1);
  for (const Scene& scene : Scenes()) {
    SCOPED_TRACE(scene.system.index());
    for (int i = 0; i < 100; ++i) {
      const double relative = i % 4 == 0 ? 0.0 : std::exp2(-Uniform(random, 3.0, 50.0));
      const SceneBox box = RandomBox(scene, 1 + static_cast<int>(random() % 12), relative, random);
      SlopeParameters parameters;
      const auto form = std::get<AffineContact>(Reduce(box, parameters, [] { return false; }));
      for (int k = 0; k < 50; ++k) {
        ExpectHolds(form, std::get<PlanarReduction>(Reduce(Inside(box, random))));
        if (HasFailure()) return;
      }
    }
  }
}

TEST(IntervalReductionTest, OfOneSceneIsItsReductionToRounding) {
  for (const Scene& scene : Scenes()) {
    SCOPED_TRACE(scene.system.index());
    SlopeParameters parameters;
    const auto form =
        std::get<AffineContact>(Reduce(SceneBox{scene, scene, std::nullopt}, parameters, [] { return false; }));
    for (const AffineInterval* one : {&form.wtt, &form.wtn, &form.wnn, &form.stick_slope, &form.u0, &form.v0}) {
      EXPECT_LE(one->range().upper - one->range().lower, 1e-13);
    }
  }
}

// Too wide by the square of the reach: ten times the reach, a hundred times the rest.
TEST(IntervalReductionTest, IsNarrowToFirstOrder) {
  const auto excess = [](double reach) {
    Scene scene = With(Chain());
    SceneBox box = {scene, scene, std::nullopt};
    const auto wnn_at = [&](double theta) {
      std::get<Linkage>(scene.system).links[1].theta_rad = theta;
      return std::get<PlanarReduction>(Reduce(scene)).w[2];
    };
    std::get<Linkage>(box.low.system).links[1].theta_rad = 0.7 - reach;
    std::get<Linkage>(box.high.system).links[1].theta_rad = 0.7 + reach;
    SlopeParameters parameters;
    const Interval wnn = std::get<AffineContact>(Reduce(box, parameters, [] { return false; })).wnn.range();
    return (wnn.upper - wnn.lower) - std::fabs(wnn_at(0.7 + reach) - wnn_at(0.7 - reach));
  };
  EXPECT_NEAR(excess(1e-2) / excess(1e-3), 100.0, 15.0);
}

TEST(IntervalReductionTest, OfAPendulumFollowsItsAngle) {
  const Scene scene = With(Pendulum{1.0, 0.3, 0.4, -1.0});
  SlopeParameters parameters;
  const auto pendulum =
      std::get<IntervalPendulum>(Reduce(SceneBox{scene, scene, Interval(0.5, 2.0)}, parameters, [] { return false; }));
  EXPECT_NEAR(pendulum.a.lower, 0.5 * std::sin(0.5), 1e-15);
  EXPECT_NEAR(pendulum.a.upper, 0.5, 1e-15);
  EXPECT_NEAR(pendulum.b.lower, 0.5 * std::cos(2.0), 1e-15);
  EXPECT_NEAR(pendulum.b.upper, 0.5 * std::cos(0.5), 1e-15);
  EXPECT_NEAR(pendulum.slope->lower, 1.0 / std::tan(2.0), 1e-15);
  EXPECT_NEAR(pendulum.slope->upper, 1.0 / std::tan(0.5), 1e-15);
}

}  // namespace
}  // namespace ricochet
