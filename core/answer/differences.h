// Derivatives from values beside the scene, for numbers that no kernel gives over dual numbers: outcomes in space, with
// compliance, in time and by the impact laws of others, and bounds.
//
// A polynomial through the values at the scene and at six neighbours on a side, or on both, is differentiated. Steps
// shrink until the error stops falling. It is estimated: what the farthest neighbours change, and the errors of the
// values over the step. Neighbours on a side must share one course of the impact, that of a scene next to this one;
// so a threshold at the number keeps its sides apart. One nearby makes steps shorter, or leaves its side to the other.
// docs/theory/derivatives.md says more.

#ifndef RICOCHET_CORE_ANSWER_DIFFERENCES_H_
#define RICOCHET_CORE_ANSWER_DIFFERENCES_H_

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "core/plan/demand.h"
#include "ricochet/derivatives.h"
#include "ricochet/outcome.h"
#include "ricochet/regime.h"
#include "ricochet/scene.h"

namespace ricochet {

// A Course tells the pieces of a piecewise smooth function of scenes from each other.
struct Course {
  Regime regime = Regime::kUnspecified;
  int slip_before = 0;   // The sign of the slip before the impact; in space 1 if there is any.
  int slip_started = 0;  // The sign of the slip that starts from rest at a contact that is rigid and in a plane.
  std::vector<EventKind> events;
  size_t alternatives = 0;
  ptrdiff_t speeds_passed = 0;  // The number of speeds listed in tables that the approach exceeds.
  friend bool operator==(const Course&, const Course&) = default;

  bool Has(EventKind kind) const { return std::find(events.begin(), events.end(), kind) != events.end(); }
  bool IsBefore(EventKind x, EventKind y) const {
    return std::find(events.begin(), events.end(), x) < std::find(events.begin(), events.end(), y);
  }
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

// Names the threshold between two scenes on the courses x and y, at which the course is `here`; unspecified if it has
// no name.
Threshold ThresholdBetween(const Course& x, const Course& y, const Course& here);

// Errors: CANCELLED once the source is stopped.
absl::StatusOr<std::vector<Derivative>> DifferencesOf(const SampleSource& source, const Scene& scene,
                                                      const DerivativePaths& paths);

// Gives the numbers `of` of outcomes for a scene as for DerivativesOf (core/answer/derivatives.h). The outcomes are
// computed as exactly as the models can, with the effects that the demand requires. `stopped` must outlive the source.
// Errors: those of SolveScene for the scene itself.
absl::StatusOr<std::unique_ptr<SampleSource>> OutcomeSamples(const Scene& scene, const Demand& demand,
                                                             const std::vector<std::string>& of,
                                                             absl::FunctionRef<bool()> stopped);

}  // namespace ricochet

#endif  // RICOCHET_CORE_ANSWER_DIFFERENCES_H_
