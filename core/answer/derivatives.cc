#include "core/answer/derivatives.h"

#include <memory>

#include "core/answer/differences.h"
#include "core/answer/exact_derivatives.h"
#include "core/answer/near_thresholds.h"

namespace ricochet {

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
