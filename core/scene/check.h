// Check: collects what is wrong, or only whether something is.

#ifndef RICOCHET_CORE_SCENE_CHECK_H_
#define RICOCHET_CORE_SCENE_CHECK_H_

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/scene/numbers.h"
#include "ricochet/error.h"

namespace ricochet {

class Check {
 public:
  // With kVerdict nothing is spelt out: a sweep asks this of every point.
  enum class Mode { kListing, kVerdict };
  explicit Check(Mode mode) : mode_(mode) {}

  // `violation()` is called only to list it.
  template <typename MakesViolation>
  void Require(bool holds, const MakesViolation& violation) {
    if (holds) return;
    failed_ = true;
    if (mode_ == Mode::kListing) violations_.push_back(violation());
  }

  // A value that is not finite breaks every rule.
  void Number(const NumberPath& path, double value, NumberRule rule) {
    Require(Holds(value, rule),
            [&] { return MakeViolation(path.Text(), value, std::isfinite(value) ? Text(rule) : "be finite"); });
  }

  void RequireSet(bool is_set, const char* field, const char* rule) {
    Require(is_set, [&] { return Violation{field, absl::StrCat("is not set: must ", rule)}; });
  }

  // Whether the list has `wanted` entries.
  bool Length(const std::string& field, size_t found, size_t wanted) {
    Require(found == wanted, [&] {
      return Violation{field, absl::StrCat("has ", found, found == 1 ? " entry" : " entries", ": must have ", wanted)};
    });
    return found == wanted;
  }

  bool failed() const { return failed_; }
  std::vector<Violation> violations() && { return std::move(violations_); }

 private:
  static const char* Text(NumberRule rule) {
    switch (rule) {
      case NumberRule::kFinite:
        return "be finite";
      case NumberRule::kPositive:
        return "be > 0";
      case NumberRule::kNotNegative:
        return "be >= 0";
      case NumberRule::kUnitInterval:
        return "be in [0, 1]";
      case NumberRule::kPlusMinusOne:
        return "be in [-1, 1]";
      case NumberRule::kOneToFour:
        return "be in [1, 4]";
      case NumberRule::kRatioSquared:
        return "be in [1e-9, 1e9]";
    }
    return "";
  }

  Mode mode_;
  bool failed_ = false;
  std::vector<Violation> violations_;
};

// The rules of a system beyond those of its single numbers: what is set, lengths of lists, definite matrices.
void CheckShape(const System& system, Check& check);

// Whether a spring's damping stands for the coefficient of restitution.
bool HasDamping(const Scene& scene);

// What compliance and finite forces go with.
void CheckEffects(const Scene& scene, Check& check);

// The rules that take the contact to decide: the velocity lies in the range of W, and the coefficients are what they
// may be at the approach speed. All others hold.
void CheckContact(const Scene& scene, Check& check);

}  // namespace ricochet

#endif  // RICOCHET_CORE_SCENE_CHECK_H_
