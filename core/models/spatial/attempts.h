// Attempts: one impact, solved until its error is as small as asked.
//
// An event that depends sensitively on the path can amplify the errors of the steps beyond what was allowed for. The
// impact is then solved again to a smaller tolerance, three times in all, and the attempt with the smallest error counts.
//
//   Attempts attempts(problem.tolerance);
//   do impact = ...; while (attempts.NeedsAnotherAfter(impact));   // to attempts.tolerance()
//   return attempts.Best();

#ifndef RICOCHET_CORE_MODELS_SPATIAL_ATTEMPTS_H_
#define RICOCHET_CORE_MODELS_SPATIAL_ATTEMPTS_H_

#include <cmath>
#include <cstdint>

#include "core/models/spatial/spatial.h"

namespace ricochet::spatial {

class Attempts {
 public:
  explicit Attempts(double tolerance) : asked_(tolerance), tolerance_(tolerance) {}

  // That of the next attempt.
  double tolerance() const { return tolerance_; }

  bool NeedsAnotherAfter(const Impact& impact) {
    const double estimate = impact.error_estimate;
    steps_ += impact.steps;
    right_hand_sides_ += impact.right_hand_sides;
    if (made_++ == 0 || estimate < best_.error_estimate) best_ = impact;
    if (made_ == kMost || estimate <= asked_ || tolerance_ <= kSmallestTolerance) return false;
    tolerance_ = std::fmax(kMargin * tolerance_ * (asked_ / estimate), kSmallestTolerance);
    return true;
  }

  Impact Best() const {
    Impact best = best_;
    best.steps = steps_;
    best.right_hand_sides = right_hand_sides_;
    if (!best.Converged()) best.regime = Regime::kWedged;
    return best;
  }

 private:
  static constexpr int kMost = 3;
  static constexpr double kSmallestTolerance = 1e-17;
  static constexpr double kMargin = 0.3;

  const double asked_;
  double tolerance_;
  int made_ = 0;
  int64_t steps_ = 0;
  int64_t right_hand_sides_ = 0;
  Impact best_;
};

// The impact of a contact that does not approach.
inline Impact SeparatingImpact(const Problem& problem) {
  auto impact = Separating<Impact>(problem.Delassus().Rank(), problem.u0, problem.v0);
  impact.closed_form = true;
  return impact;
}

}  // namespace ricochet::spatial

#endif  // RICOCHET_CORE_MODELS_SPATIAL_ATTEMPTS_H_
