#include "core/answer/scene_outcome.h"

#include <cmath>
#include <variant>

#include "core/answer/contact_notes.h"
#include "core/answer/model_outcomes.h"
#include "core/answer/notes.h"
#include "core/numerics/invariant.h"
#include "core/plan/arithmetic.h"
#include "core/plan/planned_scene.h"
#include "core/problem/scene_problem.h"
#include "ricochet/error.h"

namespace ricochet {
namespace {

// The coefficients that the model is to use.
EffectiveCoefficients EffectiveOf(const PlannedScene& planned) {
  EffectiveCoefficients effective = planned.effective;
  LeaveOut(planned.choice.left_out, effective.kinetic_friction, effective.static_friction);
  return effective;
}

// One scene on its way through the model that was chosen.
struct Job {
  const Scene& scene;
  const SolveOptions& options;
  const PlannedScene& planned;
  absl::FunctionRef<bool()> stopped;
  Outcome& outcome;

  EffectiveCoefficients Effective() const { return EffectiveOf(planned); }

  // The part of the tolerance that the effects left out do not use.
  double Tolerance() const { return ToleranceLeft(options.demand.relative_tolerance, planned.choice.negligible); }
};

absl::Status SolveCompliant(const Job& job, const PlanarReduction& reduction) {
  const compliant::Problem problem = {.contact = planar::MakeProblem(reduction, job.scene.restitution, job.Effective()),
                                      .ratio_squared = job.planned.physics.ratio_squared};
  return compliant::MakeOutcome(problem, reduction, job.options.extent, job.outcome);
}

absl::Status SolveFiniteDuration(const Job& job, const PlanarReduction& reduction) {
  const ContactPhysics physics = Without(job.planned.choice, job.planned.physics);
  finite_duration::Problem problem = {.contact = planar::MakeProblem(reduction, job.scene.restitution, job.Effective()),
                                      .tangential_acceleration = physics.tangential_acceleration,
                                      .normal_acceleration = physics.normal_acceleration,
                                      .spring = physics.spring,
                                      .tolerance = job.planned.choice.model_tolerance,
                                      .intervals = job.options.force_intervals};
  if (physics.ratio_squared > 0.0) problem.ratio_squared = physics.ratio_squared;
  return finite_duration::MakeOutcome(problem, reduction, job.options.extent, job.stopped, job.outcome);
}

template <size_t kTangential>
absl::Status SolveStraight(const Job& job, const Reduction<kTangential>& reduction) {
  const sliding::Problem<kTangential> problem = sliding::MakeProblem(reduction, job.Effective());
  const bool slides = job.planned.choice.model == Model::kSliding;
  return sliding::MakeOutcome(problem, slides ? sliding::Solve(problem) : sliding::SolveFrictionless(problem),
                              job.planned.choice.straight_errors, reduction, job.options.extent, job.outcome);
}

absl::Status SolveContact(const Job& job, const PlanarReduction& reduction) {
  const Extent& extent = job.options.extent;
  const EffectiveCoefficients effective = job.Effective();
  switch (job.planned.choice.model) {
    case Model::kImpactLaw:
      return MakeLawOutcome(job.scene.impact_law, effective.kinetic_friction, reduction, extent, job.outcome);
    case Model::kFrictionless:
    case Model::kSliding:
      return SolveStraight(job, reduction);
    case Model::kNone:
    case Model::kPlanar:
      return planar::MakeOutcome(planar::MakeProblem(reduction, job.scene.restitution, effective), reduction,
                                 job.Tolerance(), extent, job.outcome);
    case Model::kCompliant:
      return SolveCompliant(job, reduction);
    case Model::kFiniteDuration:
      return SolveFiniteDuration(job, reduction);
    case Model::kFirstOrder:
    case Model::kPendulum:
    case Model::kSpatial:
    case Model::kUnspecified:
      break;
  }
  CheckInvariant(false, "a plan gives a planar contact a planar model");
  return absl::OkStatus();
}

absl::Status SolveContact(const Job& job, const SpatialReduction& reduction) {
  const Extent& extent = job.options.extent;
  if (job.planned.choice.model == Model::kFrictionless || job.planned.choice.model == Model::kSliding) {
    return SolveStraight(job, reduction);
  }
  return spatial::MakeOutcome(spatial::Solve(SpatialProblemOf(job.scene, reduction, job.planned)), reduction, extent,
                              job.outcome);
}

absl::Status SolvePendulum(const Job& job, const pendulum::Problem& stated) {
  const pendulum::Problem problem = Without(job.planned.choice, stated);
  const Model model = job.planned.choice.model;
  return model == Model::kFrictionless || model == Model::kFirstOrder
             ? first_order::MakeOutcome(problem, job.options.extent, job.outcome)
             : pendulum::MakeOutcome(problem, job.Tolerance(), job.options.extent, job.outcome);
}

// Adds what the outcome cannot know.
void AddNotes(const Job& job, const std::optional<SceneContact>& contact) {
  const EffectiveCoefficients effective = job.Effective();
  if (job.planned.choice.model == Model::kImpactLaw) return;
  if (job.planned.closed_form.has_value()) {
    const pendulum::Problem& problem = *job.planned.closed_form;
    const bool is_idle = problem.b == 0.0 && problem.omega_minus < 0.0 && effective.static_friction > 0.0;
    if (is_idle) AddIdleFrictionNote(job.outcome);
    return;
  }
  std::visit([&](const auto& reduction) { AddContactNotes(reduction, effective, job.outcome); }, contact->reduction);
}

// The size of the contact velocity before the impact, and its normal component.
struct Approach {
  double speed, v0;
};

Approach ApproachOf(const PlannedScene& planned, const std::optional<SceneContact>& contact) {
  if (planned.closed_form.has_value()) {
    const pendulum::Problem& problem = *planned.closed_form;
    return {std::fmax(problem.a, std::fabs(problem.b)) * std::fabs(problem.omega_minus),
            problem.a * problem.omega_minus};
  }
  const auto of = [](const auto& reduction) {
    double speed = std::fabs(reduction.v0);
    for (const double u : reduction.u0) speed = std::fmax(speed, std::fabs(u));
    return Approach{speed, reduction.v0};
  };
  return std::visit(of, contact->reduction);
}

}  // namespace

absl::Status ContactOverflow() {
  return MakeError(
      absl::StatusCode::kOutOfRange, ErrorReason::kOutputOverflow,
      "the contact-space inverse inertia W or the contact velocity exceeds the largest double, or W_nn is below the "
      "smallest");
}

spatial::Problem SpatialProblemOf(const Scene& scene, const SpatialReduction& reduction, const PlannedScene& planned) {
  const double tolerance =
      planned.choice.model == Model::kNone ? spatial::kMostTolerance : planned.choice.model_tolerance;
  return spatial::MakeProblem(reduction, scene.restitution, EffectiveOf(planned), tolerance);
}

absl::Status SolveScene(const Scene& scene, std::optional<SceneContact>& contact, const SolveOptions& options,
                        absl::FunctionRef<bool()> stopped, Outcome& outcome) {
  return SolvePlanned(scene, contact, PlanScene(scene, contact, options.demand), options, stopped, outcome);
}

absl::Status SolvePlanned(const Scene& scene, const std::optional<SceneContact>& contact, const PlannedScene& planned,
                          const SolveOptions& options, absl::FunctionRef<bool()> stopped, Outcome& outcome) {
  if (planned.choice.model == Model::kUnspecified) return ContactOverflow();
  const Job job = {.scene = scene, .options = options, .planned = planned, .stopped = stopped, .outcome = outcome};
  absl::Status status =
      planned.closed_form.has_value()
          ? SolvePendulum(job, *planned.closed_form)
          : std::visit([&job](const auto& reduction) { return SolveContact(job, reduction); }, contact->reduction);
  if (!status.ok()) return status;
  outcome.effective = planned.effective;
  outcome.accuracy.relative_error += planned.choice.negligible;
  const Approach approach = ApproachOf(planned, contact);
  AddNeglected(planned.choice.negligible, approach.speed, approach.v0, outcome);
  CompareWithTolerance(options.demand.relative_tolerance, outcome);
  if (options.extent.detail == Detail::kAll) {
    Explain(planned, options.demand, outcome.plan);
    AddNotes(scene, planned, outcome);
    AddNotes(job, contact);
  } else {
    outcome.plan.model = planned.choice.model;
  }
  return absl::OkStatus();
}

absl::StatusOr<Plan> PlanOf(const Scene& scene, std::optional<SceneContact>& contact, const Demand& demand) {
  const PlannedScene planned = PlanScene(scene, contact, demand);
  if (planned.choice.model == Model::kUnspecified) return ContactOverflow();
  Plan plan;
  Explain(planned, demand, plan);
  plan.arithmetic = ArithmeticOf(scene, contact, planned, demand);
  return plan;
}

}  // namespace ricochet
