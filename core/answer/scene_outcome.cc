#include "core/answer/scene_outcome.h"

#include <utility>
#include <variant>

#include "core/answer/model_outcomes.h"
#include "core/answer/notes.h"
#include "core/answer/rates_errors.h"
#include "core/base/invariant.h"
#include "core/plan/scene_problem.h"
#include "ricochet/error.h"

namespace ricochet {
namespace {

bool IsOnePiece(const PlannedScene& planned) {
  return planned.choice.model == Model::kFrictionless || planned.choice.model == Model::kSliding;
}

template <size_t kTangential>
absl::Status SolveOnePiece(const PlannedScene& planned, const sliding::Problem<kTangential>& problem,
                           const Reduction<kTangential>& reduction, const OutcomeDetail& detail, Outcome& outcome) {
  const bool slides = planned.choice.model == Model::kSliding;
  return sliding::MakeOutcome(problem, slides ? sliding::Solve(problem) : sliding::SolveFrictionless(problem),
                              planned.choice.one_piece_errors, reduction, detail, outcome);
}

absl::Status SolveFiniteDuration(const PlannedScene& planned, const planar::Problem& contact,
                                 const PlanarReduction& reduction, const OutcomeDetail& detail,
                                 absl::FunctionRef<bool()> stopped, Outcome& outcome) {
  const ContactPhysics& physics = planned.physics;
  finite_duration::Problem problem = {.contact = contact,
                                      .tangential_acceleration = physics.tangential_acceleration,
                                      .normal_acceleration = physics.normal_acceleration,
                                      .spring = physics.spring,
                                      .tolerance = planned.choice.model_tolerance,
                                      .intervals = detail.force_intervals};
  if (physics.ratio_squared > 0.0) problem.ratio_squared = physics.ratio_squared;
  return finite_duration::MakeOutcome(problem, reduction, detail, stopped, outcome);
}

absl::Status SolveContact(const Scene& scene, const PlannedScene& planned, const planar::Problem& problem,
                          const PlanarReduction& reduction, const OutcomeDetail& detail,
                          absl::FunctionRef<bool()> stopped, Outcome& outcome) {
  switch (planned.choice.model) {
    case Model::kImpactLaw:
      return MakeLawOutcome(scene.impact_law, problem, reduction, detail, outcome);
    case Model::kFrictionless:
    case Model::kSliding:
      return SolveOnePiece(planned, SlidingProblemOf(problem), reduction, detail, outcome);
    case Model::kNone:
    case Model::kPlanar:
      return planar::MakeOutcome(problem, reduction, planned.ToleranceLeft(), detail, outcome);
    case Model::kCompliant:
      return compliant::MakeOutcome({.contact = problem, .ratio_squared = planned.physics.ratio_squared}, reduction,
                                    detail, outcome);
    case Model::kFiniteDuration:
      return SolveFiniteDuration(planned, problem, reduction, detail, stopped, outcome);
    case Model::kFirstOrder:
    case Model::kPendulum:
    case Model::kSpatial:
    case Model::kUnspecified:
      break;
  }
  CheckInvariant(false, "a plan gives a planar contact a planar model");
  return absl::OkStatus();
}

absl::Status SolveContact(const PlannedScene& planned, const spatial::Problem& problem,
                          const SpatialReduction& reduction, const OutcomeDetail& detail, Outcome& outcome) {
  if (IsOnePiece(planned)) return SolveOnePiece(planned, SlidingProblemOf(problem), reduction, detail, outcome);
  return spatial::MakeOutcome(spatial::Solve(problem), reduction, detail, outcome);
}

absl::Status SolvePendulum(const PlannedScene& planned, const pendulum::Problem& problem, const OutcomeDetail& detail,
                           Outcome& outcome) {
  const Model model = planned.choice.model;
  return model == Model::kFrictionless || model == Model::kFirstOrder
             ? first_order::MakeOutcome(problem, detail, outcome)
             : pendulum::MakeOutcome(problem, planned.ToleranceLeft(), detail, outcome);
}

absl::Status SolveProblem(const Scene& scene, const std::optional<SceneContact>& contact, const PlannedScene& planned,
                          const OutcomeDetail& detail, absl::FunctionRef<bool()> stopped, Outcome& outcome) {
  if (const auto* pendulum = std::get_if<pendulum::Problem>(&planned.problem)) {
    return SolvePendulum(planned, *pendulum, detail, outcome);
  }
  if (const auto* planar = std::get_if<planar::Problem>(&planned.problem)) {
    const auto& reduction = std::get<PlanarReduction>(contact->reduction);
    return SolveContact(scene, planned, *planar, reduction, detail, stopped, outcome);
  }
  return SolveContact(planned, std::get<spatial::Problem>(planned.problem),
                      std::get<SpatialReduction>(contact->reduction), detail, outcome);
}

Approach ApproachOf(const PlannedScene& planned) {
  struct Approaches {
    Approach operator()(std::monostate) const { return {}; }
    Approach operator()(const pendulum::Problem& problem) const {
      const planar::Problem contact = PlanarOf(problem);
      return {.u0 = {contact.u0}, .v0 = contact.v0, .wtt = contact.w.tt, .wnn = contact.w.nn};
    }
    Approach operator()(const planar::Problem& problem) const {
      return {.u0 = {problem.u0}, .v0 = problem.v0, .wtt = problem.w.tt, .wnn = problem.w.nn};
    }
    Approach operator()(const spatial::Problem& problem) const { return spatial::ApproachOf(problem); }
  };
  return std::visit(Approaches(), planned.problem);
}

}  // namespace

absl::Status ContactOverflow() {
  return MakeError(
      absl::StatusCode::kOutOfRange, ErrorReason::kOutputOverflow,
      "the contact-space inverse inertia W or the contact velocity exceeds the largest double, or W_nn is below the "
      "smallest normal one");
}

absl::Status SolveScene(const Scene& scene, std::optional<SceneContact>& contact, const Demand& demand,
                        const OutcomeDetail& detail, absl::FunctionRef<bool()> stopped, Outcome& outcome) {
  return SolvePlanned(scene, contact, PlanScene(scene, contact, demand), detail, stopped, outcome);
}

absl::Status SetFreeEnd(const Scene& scene, const Demand& demand, absl::FunctionRef<bool()> stopped, Outcome& outcome) {
  Scene free = scene;
  auto& mechanism = std::get<Mechanism>(free.system);
  mechanism.kept_coordinates.clear();
  mechanism.composite = false;
  std::optional<SceneContact> contact(std::in_place, free);
  Outcome end;
  absl::Status status = SolveScene(free, contact, demand, {}, stopped, end);
  if (!status.ok()) return status;
  outcome.free_end = FreeEnd{.regime = end.regime,
                             .termination = end.termination,
                             .admissible = end.admissible,
                             .broken_limits = std::move(end.broken_limits),
                             .coefficients = end.coefficients,
                             .rates_after = std::move(end.rates_after),
                             .contact_velocity_after = std::move(end.contact_velocity_after),
                             .impulse = std::move(end.impulse),
                             .errors = std::move(end.errors)};
  return status;
}

absl::Status SolvePlanned(const Scene& scene, const std::optional<SceneContact>& contact, const PlannedScene& planned,
                          const OutcomeDetail& detail, absl::FunctionRef<bool()> stopped, Outcome& outcome) {
  if (planned.choice.model == Model::kUnspecified) return ContactOverflow();
  absl::Status status = SolveProblem(scene, contact, planned, detail, stopped, outcome);
  if (!status.ok()) return status;
  outcome.effective = planned.effective;
  if (planned.choice.negligible > 0.0) AddNeglected(planned.choice.negligible, ApproachOf(planned), outcome);
  CompareWithTolerance(planned.demand.relative_tolerance, outcome);
  if (!detail.numbers_only) {
    Explain(planned, outcome.plan);
    AddNotes(scene, planned, outcome);
    if (contact.has_value()) SetRatesErrors(scene, *contact, outcome);
  } else {
    outcome.plan.model = planned.choice.model;
  }
  return absl::OkStatus();
}

absl::StatusOr<Plan> PlanOf(const Scene& scene, std::optional<SceneContact>& contact, const Demand& demand) {
  const PlannedScene planned = PlanScene(scene, contact, demand);
  if (planned.choice.model == Model::kUnspecified) return ContactOverflow();
  Plan plan;
  Explain(planned, plan);
  plan.arithmetic = ArithmeticOf(planned);
  return plan;
}

}  // namespace ricochet
