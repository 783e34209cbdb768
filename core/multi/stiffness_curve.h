// SampleStiffness: the outcomes of springs while the stiffness of one contact runs through a range.
//
// Samples lie evenly in the logarithm of the stiffness at first. The widest step in the outcome is halved until all are
// within kSmallStep of their scales, or as many samples are taken as may be. The outcome depends continuously on the
// stiffness, except where contacts only just touch again; a step that stays large while its ends come together is a
// jump.

#ifndef RICOCHET_CORE_MULTI_STIFFNESS_CURVE_H_
#define RICOCHET_CORE_MULTI_STIFFNESS_CURVE_H_

#include <vector>

#include "absl/functional/function_ref.h"
#include "ricochet/multi_contact.h"

namespace ricochet::multi {

inline constexpr size_t kMostStiffnessSamples = 129;

struct StiffnessCurve {
  std::vector<StiffnessSample> samples;  // By rising stiffness.
  std::vector<StiffnessJump> jumps;
};

// `springs` gives the outcome for a stiffness of the contact, and `difference` that of two outcomes over its scale, 0
// if none is known.
StiffnessCurve SampleStiffness(const StiffnessRange& range, absl::FunctionRef<AttainedOutcome(double)> springs,
                               absl::FunctionRef<double(const AttainedOutcome&, const AttainedOutcome&)> difference,
                               absl::FunctionRef<bool()> stopped);

}  // namespace ricochet::multi

#endif  // RICOCHET_CORE_MULTI_STIFFNESS_CURVE_H_
