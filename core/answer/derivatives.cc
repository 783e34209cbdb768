#include "core/answer/derivatives.h"

#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>

#include "core/answer/exact_derivatives.h"
#include "core/answer/scene_line.h"

namespace ricochet {
namespace {

// The search tries distances from 2^kFirst to 2^kLast times the size of the number, each sqrt(2) times the one before.
constexpr int kFirst = -48;
constexpr int kLast = 10;
constexpr double kHalfOctave = 0x1.6a09e667f3bcdp+0;

// One side of a number.
class Search {
 public:
  Search(const SampleSource& source, SceneLine& line, double sign) : source_(source), line_(line), sign_(sign) {}

  // Returns false once the source is stopped.
  bool Run(std::optional<NearThreshold>& found) {
    std::optional<Sample> beside;
    double reached = std::ldexp(line_.unit(), kFirst);
    if (!At(reached, beside)) return false;
    if (!beside.has_value()) {
      found = {.threshold = Threshold::kDomain};
      return true;
    }
    std::optional<Sample> beyond;
    for (int half = 1; half <= 2 * (kLast - kFirst); ++half) {
      double next = std::ldexp(half % 2 == 0 ? line_.unit() : kHalfOctave * line_.unit(), kFirst + half / 2);
      if (!At(next, beyond)) return false;
      if (!IsOther(*beside, beyond)) {
        reached = next;
        continue;
      }
      Threshold name = Threshold::kUnspecified;
      if (!Bisect(*beside, reached, next, beyond) || !NameAt(next, *beside, beyond, name)) return false;
      found = {.threshold = name, .distance = reached};
      return true;
    }
    return true;
  }

 private:
  // Says what lies at `distance`, where the sample is `there`. The last scene that keeps its rules may have a course of
  // its own, as that without friction has.
  bool NameAt(double distance, const Sample& beside, std::optional<Sample>& there, Threshold& name) {
    name = Threshold::kDomain;
    if (!there.has_value()) return true;
    const Threshold change = ThresholdBetween(beside.course, there->course, beside.course);
    if (!At(distance + std::ldexp(line_.unit(), kFirst), there)) return false;
    if (there.has_value()) name = change == Threshold::kUnspecified ? Threshold::kOther : change;
    return true;
  }

  static bool IsOther(const Sample& beside, const std::optional<Sample>& sample) {
    return !sample.has_value() || !(sample->course == beside.course);
  }

  bool At(double distance, std::optional<Sample>& sample) { return line_.At(source_, sign_ * distance, sample); }

  // Narrows [reached, other] until no number lies between, and takes the sample at `other`.
  bool Bisect(const Sample& beside, double& reached, double& other, std::optional<Sample>& beyond) {
    std::optional<Sample> sample;
    while (true) {
      const double middle = 0.5 * (reached + other);
      const double number = line_.number() + sign_ * middle;
      if (number == line_.number() + sign_ * reached || number == line_.number() + sign_ * other) return true;
      if (!At(middle, sample)) return false;
      if (IsOther(beside, sample)) {
        other = middle;
        beyond = sample;
      } else {
        reached = middle;
      }
    }
  }

  const SampleSource& source_;
  SceneLine& line_;
  const double sign_;
};

}  // namespace

absl::Status FindThresholds(const SampleSource& source, const Scene& scene, const std::vector<std::string>& by,
                            std::vector<Derivative>& derivatives) {
  for (size_t k = 0; k < by.size(); ++k) {
    SceneLine line(scene, by[k]);
    std::optional<NearThreshold> below, above;
    if (!Search(source, line, -1.0).Run(below) || !Search(source, line, 1.0).Run(above)) {
      return absl::CancelledError("the call was stopped");
    }
    for (size_t i = k; i < derivatives.size(); i += by.size()) {
      derivatives[i].below = below;
      derivatives[i].above = above;
    }
  }
  return absl::OkStatus();
}

absl::StatusOr<std::vector<Derivative>> DerivativesOf(const Scene& scene, const Demand& demand,
                                                      const DerivativePaths& paths, absl::FunctionRef<bool()> stopped) {
  const bool is_exact = WhyNotExact(scene) == nullptr;
  if (is_exact && !paths.find_thresholds) return ExactDerivativesOf(scene, paths);
  const absl::StatusOr<std::unique_ptr<SampleSource>> source = OutcomeSamples(scene, demand, paths.of, stopped);
  if (!source.ok()) return source.status();
  absl::StatusOr<std::vector<Derivative>> derivatives =
      is_exact ? ExactDerivativesOf(scene, paths) : DifferencesOf(**source, scene, paths);
  if (!derivatives.ok() || !paths.find_thresholds) return derivatives;
  const absl::Status found = FindThresholds(**source, scene, paths.by, *derivatives);
  if (!found.ok()) return found;
  return derivatives;
}

}  // namespace ricochet
