#include "core/multi/stiffness_curve.h"

#include <cmath>
#include <cstddef>

namespace ricochet::multi {
namespace {

constexpr size_t kFirstSamples = 17;
constexpr double kSmallStep = 0.02;
// Two samples whose stiffnesses have this ratio are not parted further.
constexpr double kClosest = 1.0 + 1e-6;

}  // namespace

StiffnessCurve SampleStiffness(const StiffnessRange& range, absl::FunctionRef<AttainedOutcome(double)> springs,
                               absl::FunctionRef<double(const AttainedOutcome&, const AttainedOutcome&)> difference,
                               absl::FunctionRef<bool()> stopped) {
  StiffnessCurve curve;
  std::vector<StiffnessSample>& samples = curve.samples;
  const auto sample = [&](double stiffness) {
    return StiffnessSample{.relative_stiffness = stiffness, .outcome = springs(stiffness)};
  };
  samples.push_back(sample(range.low));
  samples.push_back(sample(range.high));
  std::vector<double> steps = {difference(samples[0].outcome, samples[1].outcome)};
  const auto ratio = [&](size_t i) { return samples[i + 1].relative_stiffness / samples[i].relative_stiffness; };
  while (samples.size() < kMostStiffnessSamples && !stopped()) {
    // The first samples part the widest ratio, the others the widest step of the outcome.
    const bool is_first = samples.size() < kFirstSamples;
    size_t widest = steps.size();
    double width = is_first ? 0.0 : kSmallStep;
    for (size_t i = 0; i < steps.size(); ++i) {
      const double own = is_first ? ratio(i) : steps[i];
      if (own > width && ratio(i) > kClosest) width = own, widest = i;
    }
    if (widest == steps.size()) break;
    const double middle =
        std::sqrt(samples[widest].relative_stiffness) * std::sqrt(samples[widest + 1].relative_stiffness);
    const auto at = static_cast<std::ptrdiff_t>(widest);
    samples.insert(samples.begin() + at + 1, sample(middle));
    steps[widest] = difference(samples[widest].outcome, samples[widest + 1].outcome);
    steps.insert(steps.begin() + at + 1, difference(samples[widest + 1].outcome, samples[widest + 2].outcome));
  }
  for (size_t i = 0; i < steps.size(); ++i) {
    if (steps[i] <= kSmallStep || ratio(i) > 1.0 + 1e-3) continue;
    curve.jumps.push_back(
        {.low = samples[i].relative_stiffness, .high = samples[i + 1].relative_stiffness, .difference = steps[i]});
  }
  return curve;
}

}  // namespace ricochet::multi
