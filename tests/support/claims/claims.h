// ClaimTally: the errors that a model claims, held against the errors that it makes.
//
// Both are relative, as the model defines its error estimate. A claim below the error is broken. A claim that is far
// above the error is honest and of little use.

#ifndef RICOCHET_TESTS_SUPPORT_CLAIMS_CLAIMS_H_
#define RICOCHET_TESTS_SUPPORT_CLAIMS_CLAIMS_H_

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

namespace ricochet {

class ClaimTally {
 public:
  // `tolerance` is the error asked for; 0 if the model takes no tolerance.
  explicit ClaimTally(double tolerance = 0.0) : tolerance_(tolerance) {}

  // `scene` describes the scene to somebody who wants to look into a claim that is broken.
  void Add(double claimed, double achieved, const std::string& scene = {}) {
    ++count_;
    // An infinite claim says that nothing is known of the error.
    if (std::isinf(claimed)) {
      ++unknown_;
      return;
    }
    // An error, and a claim, below the rounding of a result counts as that rounding.
    constexpr double kRounding = 0x1p-54;
    // A NaN keeps no claim.
    if (!(claimed >= achieved) && broken_++ == 0) first_broken_ = scene;
    above_ += claimed > tolerance_ ? 1 : 0;
    exceeded_ += achieved > tolerance_ ? 1 : 0;
    worst_ = std::max(worst_, achieved);
    ratios_.push_back(std::max(claimed, kRounding) / std::max(achieved, kRounding));
  }

  int count() const { return count_; }
  int broken() const { return broken_; }
  const std::string& first_broken() const { return first_broken_; }
  int claimed_above_tolerance() const { return above_; }
  int achieved_above_tolerance() const { return exceeded_; }
  int unknown() const { return unknown_; }
  double tolerance() const { return tolerance_; }
  // The least ratio of an error claimed to the error achieved, and the median of these ratios.
  double LeastRatio() const {
    return ratios_.empty() ? std::numeric_limits<double>::infinity()
                           : *std::min_element(ratios_.begin(), ratios_.end());
  }
  double MedianRatio() const {
    if (ratios_.empty()) return std::numeric_limits<double>::infinity();
    std::vector<double> ratios = ratios_;
    const auto middle = ratios.begin() + static_cast<ptrdiff_t>(ratios.size() / 2);
    std::nth_element(ratios.begin(), middle, ratios.end());
    return *middle;
  }
  // The largest error achieved.
  double WorstError() const { return worst_; }

 private:
  double tolerance_;
  int count_ = 0, broken_ = 0, above_ = 0, exceeded_ = 0, unknown_ = 0;
  double worst_ = 0.0;
  std::string first_broken_;
  std::vector<double> ratios_;
};

// One row of the table of claims: a method, its scenes, its tally, and a goal for the median, or 0.
inline void PrintClaimsHeader() {
  std::printf("%-22s %-8s %9s %6s %8s %9s %6s %7s %5s %8s %11s %11s\n", "method", "scenes", "tolerance", "count",
              "unknown", "broken", "least", "median", "goal", "worst", "claim > tol", "error > tol");
}

inline void PrintClaims(const std::string& method, const std::string& scenes, const ClaimTally& tally,
                        double goal = 0.0) {
  std::printf("%-22s %-8s ", method.c_str(), scenes.c_str());
  if (tally.tolerance() > 0.0) {
    std::printf("%9.0e ", tally.tolerance());
  } else {
    std::printf("%9s ", "-");
  }
  std::printf("%6d %8d %9d %6.2f %7.1f ", tally.count(), tally.unknown(), tally.broken(), tally.LeastRatio(),
              tally.MedianRatio());
  if (goal > 0.0) {
    std::printf("%5.0f ", goal);
  } else {
    std::printf("%5s ", "-");
  }
  std::printf("%8.1e ", tally.WorstError());
  if (tally.tolerance() > 0.0) {
    std::printf("%11d %11d\n", tally.claimed_above_tolerance(), tally.achieved_above_tolerance());
  } else {
    std::printf("%11s %11s\n", "-", "-");
  }
  if (tally.broken() > 0) std::printf("  broken first: %s\n", tally.first_broken().c_str());
}

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_CLAIMS_CLAIMS_H_
