// Solves scenes under callgrind, so that tests/benchmark/plan_cost.py can read off what each function executes.
//
// ricochet_plan_cost lists the cases; ricochet_plan_cost CASE COUNT solves one case COUNT times and prints how often it
// asked for memory. The first call, which chooses the instruction set, comes before and is not counted.

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "absl/synchronization/mutex.h"
#include "ricochet/solver.h"
#include "tests/benchmark/measure.h"

namespace {

int64_t allocations = 0;

}  // namespace

void* operator new(size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  std::abort();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, size_t) noexcept { std::free(memory); }

namespace ricochet::bench {
namespace {

struct Case {
  std::string name;
  SolveRequest request;
};

Scene Plane(double u0, double mu) {
  return {.system = PlanarContact{2.0, 0.5, 1.0, u0, -1.0},
          .friction = {.kinetic_coefficient = mu},
          .restitution = EnergeticCoefficient{0.6}};
}

Scene Space(double slip) {
  return {.system = SpatialContact{{1.96, 0.24, 0.6, 2.96, -0.8, 1.85}, {slip, 0.6 * slip}, -1.0},
          .friction = {.kinetic_coefficient = 0.2},
          .restitution = EnergeticCoefficient{0.6}};
}

Scene ThePendulum() {
  return {.system = Pendulum{1.0, 1.0, 0.1, -1.0},
          .friction = {.kinetic_coefficient = 0.1},
          .restitution = EnergeticCoefficient{0.6}};
}

Scene Body() {
  return {.system = PlanarBody{.mass_kg = 2.0,
                               .inertia_com_kg_m2 = 0.1,
                               .offset_t_m = 0.2,
                               .offset_n_m = -0.3,
                               .velocity_t_m_s = 1.0,
                               .velocity_n_m_s = -2.0,
                               .rate_rad_s = 0.5},
          .friction = {.kinetic_coefficient = 0.3},
          .restitution = EnergeticCoefficient{0.6}};
}

Scene Sticky(Scene scene) {
  scene.friction.static_coefficient = 0.4;
  return scene;
}

Scene Compliant(Scene scene) {
  scene.compliance = {.tangential_ratio_squared = 1.2, .normal = {}};
  return scene;
}

Scene Sprung(Scene scene) {
  scene.compliance = {.tangential_ratio_squared = {}, .normal = LinearSpring{1e6}};
  return scene;
}

Scene Heavy(Scene scene) {
  scene.finite_forces = ContactAcceleration{0.0, -9.81};
  return scene;
}

// Each effect has two cases, EFFECT.off and EFFECT.on. Further cases have the defaults of a request.
std::vector<Case> Cases() {
  const DemandFields exact = {.relative_tolerance = 1e-10};
  const DemandFields in_time = {.relative_tolerance = 1e-6, .required = {Effect::kFiniteDuration}};
  // The closed form of a pendulum is the cheaper one: the form of first order serves who excludes the higher orders.
  const DemandFields first_order = {.relative_tolerance = 1e-2, .excluded = {Effect::kHigherOrder}};
  const auto request = [](Scene scene, DemandFields demand) {
    SolveRequest r;
    r.scene = std::move(scene);
    r.demand = std::move(demand);
    return r;
  };
  return {
      {"planar_body", request(Body(), {})},
      {"planar_contact", request(Plane(0.3, 0.5), {})},
      {"pendulum", request(ThePendulum(), {})},
      {"friction.off", request(Plane(3.0, 0.0), exact)},
      {"friction.on", request(Plane(3.0, 0.3), exact)},
      {"slip_stop.off", request(Plane(3.0, 0.5), exact)},
      {"slip_stop.on", request(Plane(0.3, 0.5), exact)},
      {"slip_turn.off", request(Space(3000.0), {.relative_tolerance = 0.01})},
      {"slip_turn.on", request(Space(1.0), exact)},
      {"static_friction.off", request(Plane(-0.1, 0.2), exact)},
      {"static_friction.on", request(Sticky(Plane(-0.1, 0.2)), exact)},
      {"tangential_compliance.off", request(Plane(0.3, 0.5), exact)},
      {"tangential_compliance.on", request(Compliant(Plane(0.3, 0.5)), exact)},
      {"finite_duration.off", request(Sprung(Plane(0.3, 0.5)), exact)},
      {"finite_duration.on", request(Sprung(Plane(0.3, 0.5)), in_time)},
      {"finite_forces.off", request(Sprung(Plane(0.3, 0.5)), in_time)},
      {"finite_forces.on", request(Heavy(Sprung(Plane(0.3, 0.5))), in_time)},
      {"higher_order.off", request(ThePendulum(), first_order)},
      {"higher_order.on", request(ThePendulum(), exact)},
  };
}

// Solves a request and frees the answer. It is not inlined, because plan_cost.py looks for it by name.
[[gnu::noinline]] double SolveOnce(const LocalSolver& solver, const SolveRequest& request) {
  const absl::StatusOr<SolveResponse> response = solver.Solve(request);
  if (!response.ok()) {
    std::fprintf(stderr, "%s\n", response.status().ToString().c_str());
    std::exit(1);
  }
  return response->outcome.contact_velocity_after.normal_m_s;
}

// It is not inlined, because plan_cost.py counts the instructions inside it.
[[gnu::noinline]] void SolveRepeatedly(const LocalSolver& solver, const SolveRequest& request, int count) {
  double sum = 0.0;
  const int64_t before = allocations;
  for (int i = 0; i < count; ++i) sum += SolveOnce(solver, request);
  std::printf("%lld\n", static_cast<long long>(allocations - before));
  DoNotOptimize(sum);
}

int Main(int argc, char** argv) {
  const LocalSolver solver;  // A caller keeps its solver from call to call.
  for (const Case& one : Cases()) {
    if (argc != 3) {
      std::printf("%s\n", one.name.c_str());
    } else if (one.name == argv[1]) {
      DoNotOptimize(SolveOnce(solver, one.request));
      SolveRepeatedly(solver, one.request, std::atoi(argv[2]));
    }
  }
  return 0;
}

}  // namespace
}  // namespace ricochet::bench

int main(int argc, char** argv) {
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
  return ricochet::bench::Main(argc, argv);
}
