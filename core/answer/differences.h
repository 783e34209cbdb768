// Derivatives from values beside the scene, for numbers that no kernel gives over dual numbers: outcomes in space, with
// compliance, in time and by the impact laws of others, and bounds.
//
// A polynomial through the values at the scene and at six neighbours on a side, or on both, is differentiated. Steps
// shrink until the error stops falling. It is estimated: what the farthest neighbours change, and the errors of the
// values over the step. Neighbours on a side must share one course of the impact, that of a scene next to this one;
// so a threshold at the number keeps its sides apart, and one nearby only makes steps shorter.
// docs/theory/derivatives.md says more.

#ifndef RICOCHET_CORE_ANSWER_DIFFERENCES_H_
#define RICOCHET_CORE_ANSWER_DIFFERENCES_H_

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "core/plan/demand.h"
#include "ricochet/derivatives.h"
#include "ricochet/outcome.h"
#include "ricochet/regime.h"
#include "ricochet/scene.h"

namespace ricochet {

// What tells the pieces of a piecewise smooth function of scenes from each other.
struct Course {
  Regime regime = Regime::kUnspecified;
  bool slips_before = false;
  std::vector<EventKind> events;
  size_t alternatives = 0;
  friend bool operator==(const Course&, const Course&) = default;

  bool Has(EventKind kind) const { return std::find(events.begin(), events.end(), kind) != events.end(); }
};

// The numbers that are asked for, at one scene.
struct Sample {
  Course course;
  std::vector<double> value;  // NaN for a number that is unset.
  std::vector<double> error;
};

// Gives samples of scenes of one form.
class SampleSource {
 public:
  SampleSource() = default;
  virtual ~SampleSource() = default;
  SampleSource(const SampleSource&) = delete;
  SampleSource& operator=(const SampleSource&) = delete;

  // Sets the sample to nothing if the scene breaks a rule or has no such numbers. Returns false once it is stopped.
  virtual bool At(const Scene& scene, std::optional<Sample>& sample) const = 0;

  // The sample of the scene itself, and what its numbers are compared with; > 0.
  const Sample& here() const { return here_; }
  double scale(size_t i) const { return scales_[i]; }

 protected:
  Sample here_;
  std::vector<double> scales_;
};

// Errors: CANCELLED once the source is stopped.
absl::StatusOr<std::vector<Derivative>> DifferencesOf(const SampleSource& source, const Scene& scene,
                                                      const DerivativePaths& paths);

// Those of an outcome, for a scene and paths as for DerivativesOf (core/answer/derivatives.h). The outcomes are
// computed as exactly as the models can, with the effects that the demand requires.
// Errors: those of SolveScene for the scene itself, and CANCELLED once `stopped` says true.
absl::StatusOr<std::vector<Derivative>> DifferencesOf(const Scene& scene, const Demand& demand,
                                                      const DerivativePaths& paths, absl::FunctionRef<bool()> stopped);

}  // namespace ricochet

#endif  // RICOCHET_CORE_ANSWER_DIFFERENCES_H_
