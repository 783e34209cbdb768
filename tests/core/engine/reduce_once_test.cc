// A request reduces its scene to a contact once, whatever asks for it.

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <string>

#include "core/contact/reduction.h"
#include "ricochet/engine_info.h"
#include "ricochet/solver.h"
#include "tests/support/scenes/system_scenes.h"

namespace {

std::atomic<int> reductions = 0;  // A sweep may be helped by other threads.

}  // namespace

// The linker sends calls of ricochet::Reduce(const Scene&) to the second of these, and calls of the first to it: see
// --wrap in the CMakeLists.txt.
namespace counted {
ricochet::AnyReduction ReduceAsBefore(const ricochet::Scene& scene) asm("__real__ZN8ricochet6ReduceERKNS_5SceneE");
ricochet::AnyReduction CountAndReduce(const ricochet::Scene& scene) asm("__wrap__ZN8ricochet6ReduceERKNS_5SceneE");
ricochet::AnyReduction CountAndReduce(const ricochet::Scene& scene) {
  ++reductions;
  return ReduceAsBefore(scene);
}
}  // namespace counted

namespace ricochet {
namespace {

int Count(const std::function<void()>& act) {
  (void)ThisEngine();  // The fingerprint, made once, reduces scenes of its own.
  reductions = 0;
  act();
  return reductions;
}

int OfSolve(const Scene& scene) {
  return Count([&] { EXPECT_TRUE(LocalSolver().Solve({.scene = scene}).ok()); });
}

TEST(ReduceOnceTest, ASolveReducesItsSceneOnce) {
  for (const System& system : Systems()) EXPECT_EQ(OfSolve(With(system)), 1) << system.index();
  Scene by_speed = With(Flat());
  by_speed.friction.by_speed = PowerLaw{.alpha = 0.1, .exponent = 0.2};
  EXPECT_EQ(OfSolve(by_speed), 1);
}

TEST(ReduceOnceTest, APendulumIsReducedOnlyWhereItsClosedFormDoesNotServe) {
  Scene scene = With(Pendulum{.inertia_kg_m2 = 1.0, .a_m = 0.3, .b_m = 1.0, .omega_minus_rad_s = -1.0});
  EXPECT_EQ(OfSolve(scene), 0);
  scene.compliance = Compliance{.tangential_ratio_squared = 1.2, .normal = {}};
  EXPECT_EQ(OfSolve(scene), 1);
}

TEST(ReduceOnceTest, BoundsAndAuditsReduceTheirSceneOnce) {
  EXPECT_EQ(Count([] { EXPECT_TRUE(LocalSolver().Bounds({.scene = With(Flat())}).ok()); }), 1);
  EXPECT_EQ(Count([] {
              const AuditRequest request = {.scene = With(Flat()),
                                            .observed = ContactVelocity{.tangential_m_s = {0.5}, .normal_m_s = 0.5}};
              EXPECT_TRUE(LocalSolver().Audit(request).ok());
            }),
            1);
}

// The reductions of a sweep of 100 points on one thread.
int OfSweep(const System& system, const std::string& path, double start, double stop) {
  const SweepRequest request = {.grid = {.scene = With(system), .axes = {{path, Linspace{start, stop, 100}}}},
                                .columns = {"coefficients.newton"}};
  return Count([&] {
    for (const auto& chunk : LocalSolver(Limits::None(), 1).Sweep(request)) EXPECT_TRUE(chunk.ok());
  });
}

TEST(ReduceOnceTest, ASweepReducesItsBaseSceneOnceAndEachPointOnce) {
  EXPECT_EQ(OfSweep(Body(), "spatial_body.linear_m_s[2]", -2.0, -1.0), 101);
}

TEST(ReduceOnceTest, ASweepThatLeavesTheSystemAloneReducesAllPointsOnce) {
  EXPECT_EQ(OfSweep(Body(), "friction.kinetic_coefficient", 0.1, 0.5), 2);
  EXPECT_EQ(OfSweep(Body(), "restitution.energetic", 0.1, 0.5), 2);
}

TEST(ReduceOnceTest, ASweepOfABodyInAPlaneReducesItsPointsInLanes) {
  EXPECT_EQ(OfSweep(Flat(), "planar_body.velocity_n_m_s", -2.0, -1.0), 1);
}

}  // namespace
}  // namespace ricochet
