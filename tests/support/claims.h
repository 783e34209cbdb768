// ClaimTally: the errors that a model claims, held against the errors that it makes.
//
// Both are relative, as the model defines its error estimate. A claim below the error has deceived. A claim that is far
// above the error is honest and of little use.

#ifndef RICOCHET_TESTS_SUPPORT_CLAIMS_H_
#define RICOCHET_TESTS_SUPPORT_CLAIMS_H_

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

namespace ricochet {

class ClaimTally {
 public:
  // `tolerance` is the error asked for; 0 if the model takes no tolerance.
  explicit ClaimTally(double tolerance) : tolerance_(tolerance) {}

  void Add(double claimed, double achieved) {
    // An error below the rounding of a result counts as that rounding.
    constexpr double kRounding = 0x1p-54;
    deceived_ += claimed >= achieved ? 0 : 1;
    above_ += claimed > tolerance_ ? 1 : 0;
    exceeded_ += achieved > tolerance_ ? 1 : 0;
    unknown_ += std::isinf(claimed) ? 1 : 0;
    least_ = std::min(least_, claimed / std::max(achieved, kRounding));
    worst_ = std::max(worst_, achieved);
    ratios_.push_back(claimed / std::max(achieved, kRounding));
  }

  size_t count() const { return ratios_.size(); }
  int deceived() const { return deceived_; }
  int claimed_above_tolerance() const { return above_; }
  int achieved_above_tolerance() const { return exceeded_; }
  int unknown() const { return unknown_; }
  double tolerance() const { return tolerance_; }
  // The least ratio of an error claimed to the error achieved, and the median of these ratios.
  double LeastRatio() const { return least_; }
  double MedianRatio() const {
    std::vector<double> ratios = ratios_;
    const auto middle = ratios.begin() + static_cast<ptrdiff_t>(ratios.size() / 2);
    std::nth_element(ratios.begin(), middle, ratios.end());
    return *middle;
  }
  // The largest error achieved.
  double WorstError() const { return worst_; }

 private:
  double tolerance_;
  int deceived_ = 0, above_ = 0, exceeded_ = 0, unknown_ = 0;
  double least_ = std::numeric_limits<double>::infinity();
  double worst_ = 0.0;
  std::vector<double> ratios_;
};

// One row of the table of claims: a method, its scenes, and its tally.
inline void PrintClaimsHeader() {
  std::printf("%-16s %-8s %9s %7s %9s %8s %8s %10s %11s %11s\n", "method", "scenes", "tolerance", "count", "deceived",
              "least", "median", "worst", "claim above", "error above");
}

inline void PrintClaims(const std::string& method, const std::string& scenes, const ClaimTally& tally) {
  std::printf("%-16s %-8s %9.0e %7zu %9d %8.2f %8.1f %10.1e %11d %11d\n", method.c_str(), scenes.c_str(),
              tally.tolerance(), tally.count(), tally.deceived(), tally.LeastRatio(), tally.MedianRatio(),
              tally.WorstError(), tally.claimed_above_tolerance(), tally.achieved_above_tolerance());
}

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_CLAIMS_H_
