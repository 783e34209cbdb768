#include "core/answer/bounds_derivatives.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <variant>

#include "absl/strings/match.h"
#include "core/answer/derivative_paths.h"
#include "core/answer/differences.h"
#include "core/answer/scene_bounds.h"
#include "core/contact/scene_contact.h"
#include "core/models/spatial/spatial.h"
#include "core/scene/field.h"
#include "core/scene/validate.h"

namespace ricochet {
namespace {

std::vector<double> NumbersAt(const Bounds& bounds, const std::vector<std::string>& paths) {
  std::vector<double> numbers;
  for (const std::string& path : paths) {
    numbers.push_back(BoundsNumber(bounds, path).value_or(std::numeric_limits<double>::quiet_NaN()));
  }
  return numbers;
}

// True if slip stops before the last end of the bounds, the one that energy alone allows. In a plane it stops where
// u0 + (Wtn - sign(u0) mu Wtt) tau = 0. Numbers of that end have a kink there, which no regime tells.
bool SlipStops(const SceneContact& contact, const Bounds& bounds) {
  const auto* const reduction = std::get_if<PlanarReduction>(&contact.reduction);
  if (reduction == nullptr || !bounds.energy_only.has_value()) return false;
  const auto& [tt, tn, nn] = reduction->w;
  const double slip = reduction->u0[0];
  const double change = tn - std::copysign(contact.coefficients.kinetic_friction * tt, slip);
  return slip * change < 0.0 && std::fabs(slip) < std::fabs(change) * bounds.energy_only->normal_total_n_s.upper;
}

class BoundsSource final : public SampleSource {
 public:
  BoundsSource(const Scene& scene, const Bounds& here, const std::vector<std::string>& paths,
               absl::FunctionRef<bool()> stopped)
      : paths_(paths), stopped_(stopped) {
    // Coefficients are compared with 1, impulses with the largest.
    for (const std::string& path : paths) {
      const double value = std::fabs(BoundsNumber(here, path).value_or(0.0));
      const bool is_impulse = absl::StrContains(path, "_n_s.");
      scales_.push_back(
          std::max({value, is_impulse ? here.sharp.normal_total_n_s.upper : 1.0, std::numeric_limits<double>::min()}));
    }
    here_ = SampleOf(SceneContact(scene), here);
  }

  bool At(const Scene& scene, std::optional<Sample>& sample) const override {
    sample.reset();
    if (stopped_()) return false;
    std::optional<SceneContact> contact;
    if (!Validate(scene, RestitutionIs::kOptional, contact).empty()) return true;
    const absl::StatusOr<Bounds> bounds = SolveSceneBounds(scene, contact, stopped_);
    if (bounds.ok()) sample = SampleOf(contact.has_value() ? *contact : SceneContact(scene), *bounds);
    return !absl::IsCancelled(bounds.status());
  }

 private:
  Sample SampleOf(const SceneContact& contact, const Bounds& bounds) const {
    // Bounds in a plane are right to a few ulp, those in space to the tolerance of the impacts that they are made of.
    const double relative = bounds.sampled ? spatial::kStudyTolerance : 0x1p-50;
    Sample sample = {.course = {.regime = bounds.regime}, .value = NumbersAt(bounds, paths_)};
    if (SlipStops(contact, bounds)) sample.course.events = {EventKind::kSlipStops};
    for (const double scale : scales_) sample.error.push_back(relative * scale);
    return sample;
  }

  const std::vector<std::string>& paths_;
  absl::FunctionRef<bool()> stopped_;
};

}  // namespace

std::vector<Violation> CheckBoundsDerivatives(const Scene& scene, const DerivativePaths& paths) {
  std::vector<Violation> violations;
  CheckPaths("of", paths.of, BoundsNumbers(scene.system), "an end of a range or a critical friction of the bounds",
             violations);
  if (paths.find_thresholds) {
    violations.push_back(MakeViolation("derivatives.find_thresholds", "is set", "not be, for bounds"));
  }
  std::vector<std::string> by = AllFieldPaths(scene);
  std::erase_if(by, [](const std::string& path) { return absl::StartsWith(path, "restitution."); });
  CheckPaths("by", paths.by, by, "a number of the scene other than restitution", violations);
  return violations;
}

absl::StatusOr<std::vector<Derivative>> BoundsDerivativesOf(const Scene& scene, const Bounds& bounds,
                                                            const DerivativePaths& paths,
                                                            absl::FunctionRef<bool()> stopped) {
  return DifferencesOf(BoundsSource(scene, bounds, paths.of, stopped), scene, paths);
}

}  // namespace ricochet
