// ImpactTally: compares a bound on the change by an effect with the true change, over many impacts.

#ifndef RICOCHET_TESTS_SUPPORT_CLAIMS_IMPACT_TALLY_H_
#define RICOCHET_TESTS_SUPPORT_CLAIMS_IMPACT_TALLY_H_

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>

#include "core/plan/perturbed_path.h"
#include "core/plan/sizes.h"

namespace ricochet {

// Requires that no true change exceeds its bound, and that the bound allows the effect to be left out of at least 90 %
// of the scenes whose true change is below a hundredth of a tolerance. Prints a line of a table.
class ImpactTally {
 public:
  explicit ImpactTally(std::string name) : name_(std::move(name)) {}

  // `noise` bounds the errors of the two impacts themselves.
  void Add(const Size& size, double change, double noise, double tolerance) {
    ++count_;
    EXPECT_LE(change, size.value + noise) << name_ << ", scene " << count_;
    bounded_ += size.value < kUnbounded ? 1 : 0;
    if (!(change < 0.01 * tolerance)) return;
    const int left_out = size.value <= tolerance ? 1 : 0;
    ++small_;
    small_left_out_ += left_out;
    if (size.IsAbsent()) return;
    ++in_play_;
    in_play_left_out_ += left_out;
  }

  // At least this many scenes must have had a small change.
  void Finish(int least) const {
    std::printf(
        "  %-26s %6d scenes, bounded in %5.1f %%; of %5d that are small %5.1f %% left out, in play %5.1f %% of %5d\n",
        name_.c_str(), count_, Percent(bounded_, count_), small_, Percent(small_left_out_, small_),
        Percent(in_play_left_out_, in_play_), in_play_);
    EXPECT_GE(small_left_out_, 0.9 * small_) << name_;
    EXPECT_GE(small_, least) << name_;
  }

  // These count only the scenes whose effect is not absent by proof.
  void ExpectSharpInPlay() const { EXPECT_GE(in_play_left_out_, 0.9 * in_play_) << name_; }

 private:
  static double Percent(int part, int whole) { return 100.0 * part / std::max(whole, 1); }

  std::string name_;
  int count_ = 0, bounded_ = 0, small_ = 0, small_left_out_ = 0, in_play_ = 0, in_play_left_out_ = 0;
};

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_CLAIMS_IMPACT_TALLY_H_
