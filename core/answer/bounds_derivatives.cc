#include "core/answer/bounds_derivatives.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

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

class BoundsSource final : public SampleSource {
 public:
  BoundsSource(const Bounds& here, const std::vector<std::string>& paths, absl::FunctionRef<bool()> stopped)
      : paths_(paths), stopped_(stopped) {
    // Coefficients are compared with 1, impulses with the largest.
    for (const std::string& path : paths) {
      const double value = std::fabs(BoundsNumber(here, path).value_or(0.0));
      const bool is_impulse = absl::StrContains(path, "_n_s.");
      scales_.push_back(
          std::max({value, is_impulse ? here.sharp.normal_total_n_s.upper : 1.0, std::numeric_limits<double>::min()}));
    }
    here_ = SampleOf(here);
  }

  bool At(const Scene& scene, std::optional<Sample>& sample) const override {
    sample.reset();
    if (stopped_()) return false;
    std::optional<SceneContact> contact;
    if (!Validate(scene, RestitutionIs::kOptional, contact).empty()) return true;
    const absl::StatusOr<Bounds> bounds = SolveSceneBounds(scene, std::move(contact), stopped_);
    if (bounds.ok()) sample = SampleOf(*bounds);
    return !absl::IsCancelled(bounds.status());
  }

 private:
  Sample SampleOf(const Bounds& bounds) const {
    // Bounds in a plane are right to a few ulp, those in space to the tolerance of the impacts that they are made of.
    const double relative = bounds.sampled ? spatial::kStudyTolerance : 0x1p-50;
    Sample sample = {.course = {.regime = bounds.regime}, .value = NumbersAt(bounds, paths_)};
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
  return DifferencesOf(BoundsSource(bounds, paths.of, stopped), scene, paths);
}

}  // namespace ricochet
