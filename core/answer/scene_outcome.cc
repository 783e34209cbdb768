#include "core/answer/scene_outcome.h"

#include <cassert>
#include <variant>

#include "core/answer/compliant_outcome.h"
#include "core/answer/finite_duration_outcome.h"
#include "core/answer/first_order_outcome.h"
#include "core/answer/law_outcome.h"
#include "core/answer/pendulum_outcome.h"
#include "core/answer/planar_outcome.h"
#include "core/answer/sliding_outcome.h"
#include "core/answer/spatial_outcome.h"
#include "core/plan/planned_scene.h"
#include "core/problem/scene_problem.h"
#include "ricochet/error.h"

namespace ricochet {
namespace {

// One scene on its way through the model that was chosen.
struct Job {
  const Scene& scene;
  const SolveOptions& options;
  const PlannedScene& planned;
  absl::FunctionRef<bool()> stopped;

  // The coefficients that the model is to use.
  EffectiveCoefficients Effective() const {
    EffectiveCoefficients effective = planned.effective;
    LeaveOut(planned.choice.LeftOut(), effective.kinetic_friction, effective.static_friction);
    return effective;
  }
};

absl::StatusOr<Outcome> SolveCompliant(const Job& job, const PlanarReduction& reduction) {
  const compliant::Problem problem = {.contact = planar::MakeProblem(reduction, job.scene.restitution, job.Effective()),
                                      .ratio_squared = job.planned.physics.ratio_squared};
  return compliant::MakeOutcome(problem, reduction, job.options.history_at_n_s, job.options.detail);
}

absl::StatusOr<Outcome> SolveFiniteDuration(const Job& job, const PlanarReduction& reduction) {
  const ContactPhysics physics = Without(job.planned.choice, job.planned.physics);
  finite_duration::Problem problem = {.contact = planar::MakeProblem(reduction, job.scene.restitution, job.Effective()),
                                      .tangential_acceleration = physics.tangential_acceleration,
                                      .normal_acceleration = physics.normal_acceleration,
                                      .spring = physics.spring,
                                      .tolerance = job.planned.choice.model_tolerance,
                                      .intervals = job.options.force_intervals};
  if (physics.ratio_squared > 0.0) problem.ratio_squared = physics.ratio_squared;
  return finite_duration::MakeOutcome(problem, reduction, job.options.history_at_n_s, job.stopped, job.options.detail);
}

absl::StatusOr<Outcome> SolveContact(const Job& job, const PlanarReduction& reduction) {
  const auto& [history, intervals, demand, detail] = job.options;
  const EffectiveCoefficients effective = job.Effective();
  switch (job.planned.choice.model) {
    case Model::kImpactLaw:
      return MakeLawOutcome(job.scene.impact_law, effective.kinetic_friction, reduction, history, detail);
    case Model::kFrictionless:
      return sliding::MakeFrictionlessOutcome(sliding::MakeProblem(reduction, effective), reduction, history, detail);
    case Model::kSliding:
      return sliding::MakeOutcome(sliding::MakeProblem(reduction, effective), reduction, history, detail);
    case Model::kNone:
    case Model::kPlanar:
      return planar::MakeOutcome(planar::MakeProblem(reduction, job.scene.restitution, effective), reduction, history,
                                 detail);
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
  assert(false);
  return ContactOverflow();
}

absl::StatusOr<Outcome> SolveContact(const Job& job, const SpatialReduction& reduction) {
  const auto& [history, intervals, demand, detail] = job.options;
  const EffectiveCoefficients effective = job.Effective();
  if (job.planned.choice.model == Model::kFrictionless) {
    return sliding::MakeFrictionlessOutcome(sliding::MakeProblem(reduction, effective), reduction, history, detail);
  }
  if (job.planned.choice.model == Model::kSliding) {
    return sliding::MakeOutcome(sliding::MakeProblem(reduction, effective), reduction, history, detail);
  }
  const double tolerance =
      job.planned.choice.model == Model::kNone ? spatial::kMostTolerance : job.planned.choice.model_tolerance;
  return spatial::MakeOutcome(spatial::MakeProblem(reduction, job.scene.restitution, effective, tolerance), reduction,
                              history, detail);
}

absl::StatusOr<Outcome> SolveContact(const Job& job, const pendulum::Problem& problem) {
  const auto& [history, intervals, demand, detail] = job.options;
  switch (job.planned.choice.model) {
    case Model::kFrictionless:
    case Model::kFirstOrder:
      return first_order::MakeOutcome(Without(job.planned.choice, problem), history, detail);
    case Model::kNone:
    case Model::kPendulum:
      return pendulum::MakeOutcome(Without(job.planned.choice, problem), history, detail);
    case Model::kSliding:
    case Model::kPlanar:
    case Model::kSpatial:
    case Model::kCompliant:
    case Model::kFiniteDuration:
    case Model::kImpactLaw:
    case Model::kUnspecified:
      break;
  }
  return SolveContact(job, *job.planned.reduced_pendulum);
}

}  // namespace

absl::Status ContactOverflow() {
  return MakeError(
      absl::StatusCode::kOutOfRange, ErrorReason::kOutputOverflow,
      "the contact-space inverse inertia W or the contact velocity exceeds the largest double, or W_nn is below the "
      "smallest");
}

absl::StatusOr<Outcome> SolveScene(const Scene& scene, std::optional<SceneContact> contact, const SolveOptions& options,
                                   absl::FunctionRef<bool()> stopped) {
  const PlannedScene planned = PlanScene(scene, std::move(contact), options.demand);
  if (planned.choice.model == Model::kUnspecified) return ContactOverflow();
  const Job job = {.scene = scene, .options = options, .planned = planned, .stopped = stopped};
  absl::StatusOr<Outcome> outcome =
      std::visit([&job](const auto& planned_contact) { return SolveContact(job, planned_contact); }, planned.contact);
  if (!outcome.ok()) return outcome;
  outcome->effective = planned.effective;
  outcome->accuracy.relative_error += planned.choice.Negligible();
  outcome->plan.model = planned.choice.model;
  if (options.detail == Detail::kAll) outcome->plan = Explain(planned, options.demand);
  return outcome;
}

absl::StatusOr<Outcome> PlanSceneOnly(const Scene& scene, std::optional<SceneContact> contact, const Demand& demand) {
  const PlannedScene planned = PlanScene(scene, std::move(contact), demand);
  if (planned.choice.model == Model::kUnspecified) return ContactOverflow();
  Outcome outcome;
  outcome.plan = Explain(planned, demand);
  return outcome;
}

}  // namespace ricochet
