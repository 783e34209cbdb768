// The thresholds nearest to a scene along one of its numbers: Derivative::below and Derivative::above.

#ifndef RICOCHET_CORE_ANSWER_NEAR_THRESHOLDS_H_
#define RICOCHET_CORE_ANSWER_NEAR_THRESHOLDS_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "core/answer/differences.h"
#include "ricochet/derivatives.h"
#include "ricochet/scene.h"

namespace ricochet {

// Sets both in each derivative by a number of `by`; `derivatives` has those of the first number of the outcome by
// every number first. Distances grow from next to the scene until the course changes, and the change is then bisected.
// Errors: CANCELLED once the source is stopped.
absl::Status FindThresholds(const SampleSource& source, const Scene& scene, const std::vector<std::string>& by,
                            std::vector<Derivative>& derivatives);

}  // namespace ricochet

#endif  // RICOCHET_CORE_ANSWER_NEAR_THRESHOLDS_H_
