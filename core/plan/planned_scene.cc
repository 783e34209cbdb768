#include "core/plan/planned_scene.h"

#include <optional>
#include <variant>

#include "core/contact/scene_contact.h"
#include "core/plan/arithmetic.h"
#include "core/plan/explain.h"
#include "core/plan/scene_problem.h"

namespace ricochet {
namespace {

constexpr PlannedArithmetic kOnlyArithmetic = {.arithmetic = Arithmetic::kPlain, .reason = ArithmeticReason::kOnlyOne};

bool IsAnsweredInTime(Model model) { return model == Model::kCompliant || model == Model::kFiniteDuration; }

void PlanPendulum(const Scene& scene, std::optional<SceneContact>& contact, PlannedScene& planned) {
  auto& problem = planned.problem.emplace<pendulum::Problem>(ClosedFormProblem(scene));
  planned.effective = {.kinetic_friction = problem.mu, .static_friction = problem.mu_static};
  if (!std::holds_alternative<std::monostate>(scene.restitution)) planned.effective.restitution = problem.coefficient;
  // Finite forces have time to act only if the contact is compliant.
  if (scene.compliance.has_value()) {
    if (!contact.has_value()) contact.emplace(scene);
    if (!FitsDoubles(contact->reduction)) return;
    planned.physics = PhysicsOf(scene, std::get<PlanarReduction>(contact->reduction));
  }
  planned.choice = ChoosePendulum(problem, planned.physics, planned.demand);
  if (IsAnsweredInTime(planned.choice.model)) {
    const auto& reduction = std::get<PlanarReduction>(contact->reduction);
    planned.problem = planar::MakeProblem(reduction, scene.restitution, planned.effective);
  }
}

void PlanReduced(const Scene& scene, const PlanarReduction& reduction, PlannedScene& planned) {
  const auto& problem =
      planned.problem.emplace<planar::Problem>(planar::MakeProblem(reduction, scene.restitution, planned.effective));
  planned.physics = PhysicsOf(scene, reduction);
  if (std::holds_alternative<std::monostate>(scene.impact_law)) {
    planned.choice = ChoosePlanar(problem, planned.physics, planned.demand);
  } else {
    planned.choice.model = Model::kImpactLaw;
  }
}

void PlanReduced(const Scene& scene, const SpatialReduction& reduction, PlannedScene& planned) {
  auto& problem = planned.problem.emplace<spatial::Problem>(
      spatial::MakeProblem(reduction, scene.restitution, planned.effective, spatial::kLeastTolerance));
  planned.choice = ChooseSpatial(problem, planned.demand);
  problem.tolerance = planned.choice.model == Model::kNone ? spatial::kMostTolerance : planned.choice.model_tolerance;
}

void LeaveOut(EffectSet effects, PlannedScene& planned) {
  if (effects.IsEmpty()) return;
  const auto leave_out = [effects](auto& problem) {
    if constexpr (requires { problem.mu; }) LeaveOut(effects, problem.mu, problem.mu_static);
  };
  std::visit(leave_out, planned.problem);
  planned.physics = Without(effects, planned.physics);
}

}  // namespace

double PlannedScene::ToleranceLeft() const {
  return ricochet::ToleranceLeft(demand.relative_tolerance, choice.negligible);
}

ContactPhysics PhysicsOf(const Scene& scene, const PlanarReduction& reduction) {
  ContactPhysics physics;
  physics.tangential_acceleration = reduction.acceleration[0];
  physics.normal_acceleration = reduction.acceleration[1];
  if (!scene.compliance.has_value()) return physics;
  physics.ratio_squared = scene.compliance->tangential_ratio_squared.value_or(0.0);
  physics.spring = scene.compliance->normal;
  return physics;
}

PlannedScene PlanScene(const Scene& scene, std::optional<SceneContact>& contact, const Demand& demand) {
  PlannedScene planned = {.demand = demand};
  if (HasClosedForm(scene)) {
    PlanPendulum(scene, contact, planned);
  } else {
    if (!contact.has_value()) contact.emplace(scene);
    if (!FitsDoubles(contact->reduction)) return planned;
    planned.effective = contact->coefficients;
    std::visit([&](const auto& reduction) { PlanReduced(scene, reduction, planned); }, contact->reduction);
  }
  LeaveOut(planned.choice.left_out, planned);
  return planned;
}

PlannedArithmetic ArithmeticOf(const PlannedScene& planned) {
  if (!HasChoiceOfArithmetic(planned.choice.model)) return kOnlyArithmetic;
  if (const auto* pendulum = std::get_if<pendulum::Problem>(&planned.problem)) {
    return SolveWithin(*pendulum, planned.ToleranceLeft()).arithmetic;
  }
  return SolveWithin(std::get<planar::Problem>(planned.problem), planned.ToleranceLeft()).arithmetic;
}

void Explain(const PlannedScene& planned, Plan& plan) {
  if (!HasChoiceOfArithmetic(planned.choice.model)) plan.arithmetic = kOnlyArithmetic;
  if (planned.choice.model != Model::kImpactLaw) return Explain(planned.choice, planned.demand, plan);
  plan.model = Model::kImpactLaw;
  plan.relative_tolerance = planned.demand.relative_tolerance;
}

}  // namespace ricochet
