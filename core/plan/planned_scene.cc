#include "core/plan/planned_scene.h"

#include "core/plan/arithmetic.h"
#include "core/plan/explain.h"
#include "core/plan/scene_problem.h"

namespace ricochet {
namespace {

constexpr PlannedArithmetic kOnlyArithmetic = {.arithmetic = Arithmetic::kPlain, .reason = ArithmeticReason::kOnlyOne};

bool IsAnsweredInTime(Model model) { return model == Model::kCompliant || model == Model::kFiniteDuration; }

// A plan is large to copy, so that each of these functions makes it in place.
PlannedScene PlanPendulum(const Scene& scene, std::optional<SceneContact>& contact, const Demand& demand) {
  const pendulum::Problem problem = ClosedFormProblem(scene);
  EffectiveCoefficients effective = {.kinetic_friction = problem.mu, .static_friction = problem.mu_static};
  if (!std::holds_alternative<std::monostate>(scene.restitution)) effective.restitution = problem.coefficient;
  ContactPhysics physics;
  bool fits = true;
  // Finite forces have time to act only if the contact is compliant.
  if (scene.compliance.has_value()) {
    if (!contact.has_value()) contact.emplace(scene);
    fits = FitsDoubles(contact->reduction);
    if (fits) physics = PhysicsOf(scene, std::get<PlanarReduction>(contact->reduction));
  }
  PlannedScene planned = {.problem = problem,
                          .physics = physics,
                          .effective = effective,
                          .choice = fits ? ChoosePendulum(problem, physics, demand) : Choice(),
                          .demand = demand};
  if (IsAnsweredInTime(planned.choice.model)) {
    const auto& reduction = std::get<PlanarReduction>(contact->reduction);
    planned.problem = planar::MakeProblem(reduction, scene.restitution, effective);
  }
  return planned;
}

PlannedScene PlanReduced(const Scene& scene, const PlanarReduction& reduction, const EffectiveCoefficients& effective,
                         const Demand& demand) {
  const planar::Problem problem = planar::MakeProblem(reduction, scene.restitution, effective);
  const ContactPhysics physics = PhysicsOf(scene, reduction);
  const bool has_law = !std::holds_alternative<std::monostate>(scene.impact_law);
  return {.problem = problem,
          .physics = physics,
          .effective = effective,
          .choice = has_law ? Choice{.model = Model::kImpactLaw} : ChoosePlanar(problem, physics, demand),
          .demand = demand};
}

PlannedScene PlanReduced(const Scene& scene, const SpatialReduction& reduction, const EffectiveCoefficients& effective,
                         const Demand& demand) {
  spatial::Problem problem = spatial::MakeProblem(reduction, scene.restitution, effective, spatial::kLeastTolerance);
  PlannedScene planned = {.effective = effective, .choice = ChooseSpatial(problem, demand), .demand = demand};
  problem.tolerance = planned.choice.model == Model::kNone ? spatial::kMostTolerance : planned.choice.model_tolerance;
  planned.problem = problem;
  return planned;
}

PlannedScene PlanContact(const Scene& scene, const SceneContact& contact, const Demand& demand) {
  if (!FitsDoubles(contact.reduction)) return {.demand = demand};
  return std::visit([&](const auto& reduction) { return PlanReduced(scene, reduction, contact.coefficients, demand); },
                    contact.reduction);
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
  const bool has_closed_form = HasClosedForm(scene);
  if (!has_closed_form && !contact.has_value()) contact.emplace(scene);
  PlannedScene planned = has_closed_form ? PlanPendulum(scene, contact, demand) : PlanContact(scene, *contact, demand);
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
