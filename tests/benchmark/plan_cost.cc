// What an effect costs, in instructions: run under callgrind by tests/benchmark/plan_cost.py, which makes the table.
//
// ricochet_plan_cost CASE WHAT COUNT does one thing COUNT times. WHAT: validate, plan, solve (the scene), direct (the
// model without the effect, called by hand), with (the same scene with the effect).

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "absl/synchronization/mutex.h"
#include "core/answer/compliant_outcome.h"
#include "core/answer/finite_duration_outcome.h"
#include "core/answer/first_order_outcome.h"
#include "core/answer/planar_outcome.h"
#include "core/answer/scene_outcome.h"
#include "core/answer/sliding_outcome.h"
#include "core/answer/spatial_outcome.h"
#include "core/plan/planned_scene.h"
#include "core/problem/scene_problem.h"
#include "core/scene/validate.h"
#include "tests/benchmark/measure.h"

namespace ricochet::bench {
namespace {

using Direct = std::function<absl::StatusOr<Outcome>(const PlannedScene&)>;

struct Case {
  std::string name;
  Scene without;
  Scene with;
  Demand demand;       // Of the scene without the effect.
  Demand demand_with;  // Of the one with it.
  Direct direct;
};

constexpr Detail kDetail = Detail::kNumbers;

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

Scene With(Scene scene, const std::function<void(Scene&)>& change) {
  change(scene);
  return scene;
}

const PlanarReduction& PlanarOf(const PlannedScene& planned) { return std::get<PlanarReduction>(planned.contact); }

planar::Problem ProblemOf(const PlannedScene& planned) {
  return planar::MakeProblem(PlanarOf(planned), EnergeticCoefficient{}, planned.effective);
}

absl::StatusOr<Outcome> DirectPlanar(const PlannedScene& planned) {
  return planar::MakeOutcome(ProblemOf(planned), PlanarOf(planned), {}, kDetail);
}

absl::StatusOr<Outcome> DirectSmooth(const PlannedScene& planned) {
  const PlanarReduction& reduction = PlanarOf(planned);
  return sliding::MakeFrictionlessOutcome(sliding::MakeProblem(reduction, planned.effective), reduction, {}, kDetail);
}

absl::StatusOr<Outcome> DirectSliding(const PlannedScene& planned) {
  const PlanarReduction& reduction = PlanarOf(planned);
  return sliding::MakeOutcome(sliding::MakeProblem(reduction, planned.effective), reduction, {}, kDetail);
}

absl::StatusOr<Outcome> DirectStraight(const PlannedScene& planned) {
  const auto& reduction = std::get<SpatialReduction>(planned.contact);
  return sliding::MakeOutcome(sliding::MakeProblem(reduction, planned.effective), reduction, {}, kDetail);
}

absl::StatusOr<Outcome> DirectFirstOrder(const PlannedScene& planned) {
  return first_order::MakeOutcome(std::get<pendulum::Problem>(planned.contact), {}, kDetail);
}

absl::StatusOr<Outcome> DirectFiniteDuration(const PlannedScene& planned) {
  const planar::Problem rigid = ProblemOf(planned);
  const finite_duration::Problem problem = {.wtt = rigid.wtt,
                                            .wtn = rigid.wtn,
                                            .wnn = rigid.wnn,
                                            .u0 = rigid.u0,
                                            .v0 = rigid.v0,
                                            .mu = rigid.mu,
                                            .mu_static = rigid.mu_static,
                                            .spring = planned.physics.spring,
                                            .energetic = rigid.coefficient,
                                            .tolerance = planned.choice.model_tolerance};
  return finite_duration::MakeOutcome(problem, PlanarOf(planned), {}, kDetail);
}

std::vector<Case> Cases() {
  const Demand exact = {.relative_tolerance = 1e-10};
  const Demand in_time = {.relative_tolerance = 1e-6, .required = {Effect::kFiniteDuration}};
  const auto compliant = [](Scene& s) { s.compliance = {.tangential_ratio_squared = 1.2, .normal = {}}; };
  const auto spring = [](Scene& s) { s.compliance = {.tangential_ratio_squared = {}, .normal = LinearSpring{1e6}}; };
  const auto weight = [](Scene& s) { s.finite_forces = ContactAcceleration{0.0, -9.81}; };
  const auto sticky = [](Scene& s) { s.friction.static_coefficient = 0.4; };
  const Scene spring_scene = With(Plane(0.3, 0.5), spring);
  const Scene pendulum = {.system = Pendulum{1.0, 1.0, 0.1, -1.0},
                          .friction = {.kinetic_coefficient = 0.1},
                          .restitution = EnergeticCoefficient{0.6}};
  return {
      {"friction", Plane(3.0, 0.0), Plane(3.0, 0.3), exact, exact, DirectSmooth},
      {"slip_stop", Plane(3.0, 0.5), Plane(0.3, 0.5), exact, exact, DirectSliding},
      {"slip_turn", Space(30.0), Space(1.0), {.relative_tolerance = 0.01}, exact, DirectStraight},
      {"static_friction", Plane(-0.1, 0.2), With(Plane(-0.1, 0.2), sticky), exact, exact, DirectPlanar},
      {"tangential_compliance", Plane(0.3, 0.5), With(Plane(0.3, 0.5), compliant), exact, exact, DirectPlanar},
      {"finite_duration", spring_scene, spring_scene, exact, in_time, DirectPlanar},
      {"finite_forces", spring_scene, With(spring_scene, weight), in_time, in_time, DirectFiniteDuration},
      {"higher_order", pendulum, pendulum, {.relative_tolerance = 1e-3}, exact, DirectFirstOrder},
  };
}

// A result that nobody could do without.
double Use(const absl::StatusOr<Outcome>& outcome) {
  if (!outcome.ok()) return -1.0;
  return outcome->contact_velocity_after.normal_m_s + outcome->contact_velocity_after.tangential_m_s.front();
}

double Do(const Case& one, const std::string& what, const PlannedScene& planned) {
  if (what == "validate") return static_cast<double>(Validate(one.without).size());
  if (what == "plan") return PlanScene(one.without, one.demand).choice.neglected;
  if (what == "solve") return Use(SolveScene(one.without, {.demand = one.demand, .detail = kDetail}));
  if (what == "direct") return Use(one.direct(planned));
  if (what == "with") return Use(SolveScene(one.with, {.demand = one.demand_with, .detail = kDetail}));
  std::fprintf(stderr, "no such thing to measure: %s\n", what.c_str());
  std::exit(2);
}

// Makes sure that "direct" and "solve" are the same model.
void Check(const Case& one, const PlannedScene& planned) {
  const double direct = Use(one.direct(planned));
  const double solved = Use(SolveScene(one.without, {.demand = one.demand, .detail = kDetail}));
  if (direct == solved && planned.choice.model != PlanScene(one.with, one.demand_with).choice.model) return;
  if (direct == solved && (one.name == "static_friction" || one.name == "finite_forces")) return;
  std::fprintf(stderr, "%s: the scene is not solved by the model that is called by hand\n", one.name.c_str());
  std::exit(1);
}

void Run(const Case& one, const std::string& what, int count) {
  const PlannedScene planned = PlanScene(one.without, one.demand);
  Check(one, planned);
  double sum = 0.0;
  for (int i = 0; i < count; ++i) sum += Do(one, what, planned);
  Keep(sum);
}

int Main(int argc, char** argv) {
  if (argc != 4) {
    for (const Case& one : Cases()) std::printf("%s\n", one.name.c_str());
    return 0;
  }
  for (const Case& one : Cases()) {
    if (one.name == argv[1]) Run(one, argv[2], std::atoi(argv[3]));
  }
  return 0;
}

}  // namespace
}  // namespace ricochet::bench

int main(int argc, char** argv) {
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
  return ricochet::bench::Main(argc, argv);
}
