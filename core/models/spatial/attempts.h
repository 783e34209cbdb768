// Attempts: one impact, solved until its error is as small as asked.
//
// An event that depends sensitively on the path can amplify the errors of the steps beyond what was allowed for. The
// impact is then solved again to a smaller tolerance, three times in all, and the attempt with the smallest error
// counts.
//
//   Attempts attempts(problem.tolerance, impact);
//   do attempt = ...; while (attempts.NeedsAnotherAfter(attempt));   // to attempts.tolerance()

#ifndef RICOCHET_CORE_MODELS_SPATIAL_ATTEMPTS_H_
#define RICOCHET_CORE_MODELS_SPATIAL_ATTEMPTS_H_

#include <cmath>
#include <cstdint>

#include "core/models/spatial/spatial.h"

namespace ricochet::spatial {

class Attempts {
 public:
  // The impact that counts is written to `best`.
  Attempts(double tolerance, Impact& best) : asked_(tolerance), tolerance_(tolerance), best_(&best) {}

  // The next attempt uses it.
  double tolerance() const { return tolerance_; }

  bool NeedsAnotherAfter(const Impact& impact) {
    const double estimate = impact.error_estimate;
    steps_ += impact.steps;
    right_hand_sides_ += impact.right_hand_sides;
    if (made_++ == 0 || estimate < best_->error_estimate) *best_ = impact;
    if (made_ < kMost && !(estimate <= asked_) && tolerance_ > kSmallestTolerance) {
      tolerance_ = std::fmax(kMargin * tolerance_ * (asked_ / estimate), kSmallestTolerance);
      return true;
    }
    best_->steps = steps_;
    best_->right_hand_sides = right_hand_sides_;
    if (!best_->Converged()) best_->regime = Regime::kWedged;
    return false;
  }

 private:
  static constexpr int kMost = 3;
  static constexpr double kSmallestTolerance = 1e-17;
  static constexpr double kMargin = 0.3;

  double asked_;
  double tolerance_;
  Impact* best_;
  int made_ = 0;
  int64_t steps_ = 0;
  int64_t right_hand_sides_ = 0;
};

// The impact of a contact that does not approach.
inline Impact SeparatingImpact(const Problem& problem) {
  auto impact = Separating<Impact>(problem.Delassus().Rank(), problem.u0, problem.v0);
  impact.closed_form = true;
  impact.errors = NoErrors();
  return impact;
}

}  // namespace ricochet::spatial

#endif  // RICOCHET_CORE_MODELS_SPATIAL_ATTEMPTS_H_
