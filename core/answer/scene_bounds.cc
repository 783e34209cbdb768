#include "core/answer/scene_bounds.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "absl/strings/str_cat.h"
#include "core/answer/scene_outcome.h"
#include "core/bounds/contact_bounds.h"
#include "core/bounds/nearly_vertical.h"
#include "core/bounds/pendulum_bounds.h"
#include "core/contact/coefficients_at_speed.h"
#include "core/contact/reduction.h"
#include "core/plan/scene_problem.h"
#include "core/types/named_ranges.h"

namespace ricochet {
namespace {

Bounds PendulumBounds(const Scene& scene) {
  const pendulum::Problem problem = ClosedFormProblem(scene);
  Bounds bounds = pendulum::SolveBounds(problem);
  if (bounds.slope_ratio > 0.0 && bounds.regime != Regime::kLocked) {
    const bool has_restitution = !std::holds_alternative<std::monostate>(scene.restitution);
    bounds.nearly_vertical = pendulum::SolveNearlyVertical(problem, has_restitution);
  }
  return bounds;
}

// Widens the range to the value of impact `i`; the first one alone makes the range.
void Include(int i, double value, Range& range) {
  range.lower = i == 0 ? value : std::min(range.lower, value);
  range.upper = i == 0 ? value : std::max(range.upper, value);
}

absl::Status NotEnded() {
  return MakeError(absl::StatusCode::kOutOfRange, ErrorReason::kNotEnded,
                   "bounds.sharp: an elastic or a plastic impact has no end, or none within the steps of the model");
}

absl::StatusOr<Bounds> SampledBounds(const SpatialReduction& reduction, const EffectiveCoefficients& effective,
                                     absl::FunctionRef<bool()> stopped) {
  spatial::Problem problem =
      spatial::MakeProblem(reduction, EnergeticCoefficient{}, effective, spatial::kStudyTolerance);
  Bounds bounds;
  bounds.sampled = true;
  CoefficientBounds& sharp = bounds.sharp;
  for (int i = 0; i < kSpatialImpacts; ++i) {
    if (stopped()) return absl::CancelledError("the bounds were stopped by their caller");
    problem.coefficient = static_cast<double>(i) / (kSpatialImpacts - 1);
    const spatial::Impact impact = spatial::Solve(problem);
    if (!impact.Converged()) return NotEnded();
    bounds.regime = impact.regime;
    Include(i, impact.newton, sharp.newton);
    Include(i, impact.poisson, sharp.poisson);
    Include(i, impact.energetic, sharp.energetic);
    Include(i, impact.tangential, sharp.tangential);
    Include(i, impact.tau1, sharp.normal_total_n_s);
  }
  return bounds;
}

absl::StatusOr<Bounds> ReducedBounds(const SceneContact& contact, absl::FunctionRef<bool()> stopped) {
  const auto& [any, effective] = contact;
  if (!FitsDoubles(any)) return ContactOverflow();
  if (const auto* spatial = std::get_if<SpatialReduction>(&any)) return SampledBounds(*spatial, effective, stopped);
  const Bounds bounds = planar::SolveBounds(planar::MakeProblem(std::get<PlanarReduction>(any), {}, effective));
  if (bounds.regime == Regime::kWedged) return NotEnded();
  return bounds;
}

absl::Status CheckFinite(const CoefficientBounds& bounds, const std::string& path) {
  for (const auto& [name, range] : kNamedRanges) {
    if (!std::isfinite((bounds.*range).upper)) return OutputOverflow(absl::StrCat(path, name, ".upper"));
    if (!std::isfinite((bounds.*range).lower)) return OutputOverflow(absl::StrCat(path, name, ".lower"));
  }
  return absl::OkStatus();
}

absl::Status CheckFinite(const Bounds& bounds) {
  if (!std::isfinite(bounds.friction_ratio)) return OutputOverflow("bounds.friction_ratio");
  absl::Status status = CheckFinite(bounds.sharp, "bounds.sharp.");
  if (bounds.energy_only.has_value()) status.Update(CheckFinite(*bounds.energy_only, "bounds.energy_only."));
  if (!bounds.nearly_vertical.has_value()) return status;
  status.Update(CheckFinite(bounds.nearly_vertical->bounds, "bounds.nearly_vertical.bounds."));
  return status;
}

}  // namespace

absl::StatusOr<Bounds> SolveSceneBounds(const Scene& scene, std::optional<SceneContact> contact,
                                        absl::FunctionRef<bool()> stopped) {
  const bool closed_form = HasClosedForm(scene);
  if (!closed_form && !contact.has_value()) contact.emplace(scene);
  absl::StatusOr<Bounds> bounds = closed_form ? PendulumBounds(scene) : ReducedBounds(*contact, stopped);
  if (!bounds.ok()) return bounds;
  const absl::Status finite = CheckFinite(*bounds);
  if (!finite.ok()) return finite;
  return bounds;
}

}  // namespace ricochet
