#include "core/answer/scene_bounds.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <variant>

#include "absl/strings/str_cat.h"
#include "core/answer/scene_outcome.h"
#include "core/bounds/contact_bounds.h"
#include "core/bounds/pendulum_bounds.h"
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

absl::Status NotEnded() {
  return MakeError(absl::StatusCode::kOutOfRange, ErrorReason::kNotEnded,
                   "bounds.sharp: an elastic or a plastic impact has no end, or none within the steps of the model");
}

// The hull of impacts of one scene in space with several energetic coefficients.
class SpatialSample {
 public:
  SpatialSample(const SpatialReduction& reduction, const EffectiveCoefficients& effective,
                absl::FunctionRef<bool()> stopped)
      : problem_(spatial::MakeProblem(reduction, EnergeticCoefficient{}, effective, spatial::kStudyTolerance)),
        stopped_(stopped) {}

  const CoefficientBounds& hull() const { return hull_; }
  Regime regime() const { return regime_; }      // That of the last impact.
  bool end_recedes() const { return recedes_; }  // In the last impact.

  absl::Status Include(double coefficient) {
    if (stopped_()) return absl::CancelledError("the bounds were stopped by their caller");
    problem_.coefficient = coefficient;
    const spatial::Impact impact = spatial::Solve(problem_);
    if (!impact.Converged()) return NotEnded();
    regime_ = impact.regime;
    recedes_ = HasEvent(impact, EventKind::kEndRecedes);
    Widen(impact.newton, hull_.newton);
    Widen(impact.poisson, hull_.poisson);
    Widen(impact.energetic, hull_.energetic);
    Widen(impact.tangential, hull_.tangential);
    Widen(impact.tau1, hull_.normal_total_n_s);
    is_empty_ = false;
    return absl::OkStatus();
  }

 private:
  void Widen(double value, Range& range) const {
    range.lower = is_empty_ ? value : std::min(range.lower, value);
    range.upper = is_empty_ ? value : std::max(range.upper, value);
  }

  spatial::Problem problem_;
  absl::FunctionRef<bool()> stopped_;
  CoefficientBounds hull_;
  Regime regime_ = Regime::kUnspecified;
  bool recedes_ = false;
  bool is_empty_ = true;
};

// The outcome jumps between two coefficients of which the larger one alone makes the end recede, and changes infinitely
// fast before the jump.
absl::Status IncludeJump(double low, double high, SpatialSample& sample) {
  for (double middle = 0.5 * (low + high); low < middle && middle < high; middle = 0.5 * (low + high)) {
    if (absl::Status included = sample.Include(middle); !included.ok()) return included;
    (sample.end_recedes() ? high : low) = middle;
  }
  return absl::OkStatus();
}

absl::StatusOr<Bounds> SampledBounds(const SpatialReduction& reduction, const EffectiveCoefficients& effective,
                                     absl::FunctionRef<bool()> stopped) {
  SpatialSample sample(reduction, effective, stopped);
  Bounds bounds;
  bounds.sampled = true;
  const auto coefficient = [](int i) { return static_cast<double>(i) / (kSpatialImpacts - 1); };
  bool receded = false;
  for (int i = 0; i < kSpatialImpacts; ++i) {
    absl::Status status = sample.Include(coefficient(i));
    bounds.regime = sample.regime();
    const bool recedes = sample.end_recedes();
    if (status.ok() && recedes && !receded) status = IncludeJump(coefficient(i - 1), coefficient(i), sample);
    if (!status.ok()) return status;
    receded = recedes;
  }
  bounds.sharp = sample.hull();
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
