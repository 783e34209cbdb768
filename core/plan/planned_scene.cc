#include "core/plan/planned_scene.h"

#include <optional>
#include <variant>

#include "core/contact/scene_contact.h"
#include "core/plan/arithmetic.h"
#include "core/plan/explain.h"
#include "core/problem/scene_problem.h"

namespace ricochet {
namespace {

ContactPhysics PhysicsOf(const Scene& scene, const PlanarReduction& reduction) {
  ContactPhysics physics;
  physics.tangential_acceleration = reduction.acceleration[0];
  physics.normal_acceleration = reduction.acceleration[1];
  if (!scene.compliance.has_value()) return physics;
  physics.ratio_squared = scene.compliance->tangential_ratio_squared.value_or(0.0);
  physics.spring = scene.compliance->normal;
  return physics;
}

constexpr PlannedArithmetic kOnlyArithmetic = {.arithmetic = Arithmetic::kPlain, .reason = ArithmeticReason::kOnlyOne};

bool IsAnsweredInTime(Model model) { return model == Model::kCompliant || model == Model::kFiniteDuration; }

void PlanPendulum(const Scene& scene, std::optional<SceneContact>& contact, const Demand& demand,
                  PlannedScene& planned) {
  const pendulum::Problem problem = ClosedFormProblem(scene);
  planned.effective = {.kinetic_friction = problem.mu, .static_friction = problem.mu_static};
  if (!std::holds_alternative<std::monostate>(scene.restitution)) planned.effective.restitution = problem.coefficient;
  // Finite forces have time to act only if the contact is compliant.
  if (scene.compliance.has_value()) {
    if (!contact.has_value()) contact.emplace(scene);
    if (!FitsDoubles(contact->reduction)) return;
    planned.physics = PhysicsOf(scene, std::get<PlanarReduction>(contact->reduction));
  }
  planned.choice = ChoosePendulum(problem, planned.physics, demand);
  if (!IsAnsweredInTime(planned.choice.model)) planned.closed_form = problem;
}

void PlanReduced(const Scene& scene, const Demand& demand, const PlanarReduction& reduction, PlannedScene& planned) {
  planned.physics = PhysicsOf(scene, reduction);
  if (!std::holds_alternative<std::monostate>(scene.impact_law)) {
    planned.choice.model = Model::kImpactLaw;
    return;
  }
  const planar::Problem problem = planar::MakeProblem(reduction, scene.restitution, planned.effective);
  planned.choice = ChoosePlanar(problem, planned.physics, demand);
}

void PlanReduced(const Scene& scene, const Demand& demand, const SpatialReduction& reduction, PlannedScene& planned) {
  planned.choice = ChooseSpatial(
      spatial::MakeProblem(reduction, scene.restitution, planned.effective, spatial::kLeastTolerance), demand);
}

}  // namespace

PlannedScene PlanScene(const Scene& scene, std::optional<SceneContact>& contact, const Demand& demand) {
  PlannedScene planned;
  if (HasClosedForm(scene)) {
    PlanPendulum(scene, contact, demand, planned);
    return planned;
  }
  if (!contact.has_value()) contact.emplace(scene);
  if (!FitsDoubles(contact->reduction)) return planned;
  planned.effective = contact->coefficients;
  std::visit([&](const auto& reduction) { PlanReduced(scene, demand, reduction, planned); }, contact->reduction);
  return planned;
}

PlannedArithmetic ArithmeticOf(const Scene& scene, const std::optional<SceneContact>& contact,
                               const PlannedScene& planned, const Demand& demand) {
  const Choice& choice = planned.choice;
  if (!HasChoiceOfArithmetic(choice.model)) return kOnlyArithmetic;
  const double tolerance = ToleranceLeft(demand.relative_tolerance, choice.negligible);
  if (planned.closed_form.has_value()) {
    return SolveWithin(Without(choice, *planned.closed_form), tolerance).arithmetic;
  }
  const auto& reduction = std::get<PlanarReduction>(contact->reduction);
  const planar::Problem problem = planar::MakeProblem(reduction, scene.restitution, planned.effective);
  return SolveWithin(Without(choice, problem), tolerance).arithmetic;
}

void Explain(const PlannedScene& planned, const Demand& demand, Plan& plan) {
  if (!HasChoiceOfArithmetic(planned.choice.model)) plan.arithmetic = kOnlyArithmetic;
  if (planned.choice.model != Model::kImpactLaw) return Explain(planned.choice, demand, plan);
  plan.model = Model::kImpactLaw;
  plan.relative_tolerance = demand.relative_tolerance;
}

}  // namespace ricochet
