#include "core/models/scene_outcome.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "core/error.h"
#include "core/models/law_outcome.h"
#include "core/models/pendulum_outcome.h"
#include "core/models/planar_outcome.h"
#include "core/models/spatial_outcome.h"
#include "core/scene/effective.h"
#include "core/scene/reduction.h"

namespace ricochet {
namespace {

double PendulumSpeed(const Pendulum& pendulum) { return std::max(0.0, -pendulum.a_m * pendulum.omega_minus_rad_s); }

absl::StatusOr<Outcome> SolveReduced(const Scene& scene, const EffectiveCoefficients& effective,
                                     const SolveOptions& options, const PlanarReduction& reduction) {
  if (!std::holds_alternative<std::monostate>(scene.impact_law)) {
    return MakeLawOutcome(scene.impact_law, effective.kinetic_friction, reduction, options.history_at_n_s,
                          options.detail);
  }
  return planar::MakeOutcome(planar::MakeProblem(reduction, scene.restitution, effective), reduction,
                             options.history_at_n_s, options.detail);
}

absl::StatusOr<Outcome> SolveReduced(const Scene& scene, const EffectiveCoefficients& effective,
                                     const SolveOptions& options, const SpatialReduction& reduction) {
  return spatial::MakeOutcome(
      spatial::MakeProblem(reduction, scene.restitution, effective,
                           std::clamp(options.tolerance, spatial::kLeastTolerance, spatial::kMostTolerance)),
      reduction, options.history_at_n_s, options.detail);
}

}  // namespace

absl::Status ContactOverflow() {
  return MakeError(absl::StatusCode::kOutOfRange, ErrorReason::kOutputOverflow,
                   "the contact-space inverse inertia or the contact velocity exceeds the largest double");
}

bool HasClosedForm(const Scene& scene) {
  return std::holds_alternative<Pendulum>(scene.system) && !scene.surface_velocity.has_value() &&
         std::holds_alternative<std::monostate>(scene.impact_law);
}

pendulum::Problem ClosedFormProblem(const Scene& scene) {
  pendulum::Problem problem = pendulum::MakeProblem(scene);
  if (!DependsOnSpeed(scene)) return problem;
  const EffectiveCoefficients effective = EffectiveAt(scene, PendulumSpeed(std::get<Pendulum>(scene.system)));
  problem.mu = effective.kinetic_friction;
  problem.mu_static = effective.static_friction;
  problem.coefficient = effective.restitution;
  return problem;
}

absl::StatusOr<Outcome> SolveScene(const Scene& scene, const SolveOptions& options) {
  if (HasClosedForm(scene)) {
    const pendulum::Problem problem = ClosedFormProblem(scene);
    absl::StatusOr<Outcome> outcome = pendulum::MakeOutcome(problem, options.history_at_n_s, options.detail);
    if (!outcome.ok()) return outcome;
    outcome->effective = {
        .kinetic_friction = problem.mu, .static_friction = problem.mu_static, .restitution = problem.coefficient};
    return outcome;
  }
  const AnyReduction any = Reduce(scene);
  if (!IsFinite(any)) return ContactOverflow();
  const EffectiveCoefficients effective = EffectiveAt(scene, ApproachSpeed(any));
  absl::StatusOr<Outcome> outcome =
      std::visit([&](const auto& reduction) { return SolveReduced(scene, effective, options, reduction); }, any);
  if (outcome.ok()) outcome->effective = effective;
  return outcome;
}

}  // namespace ricochet
