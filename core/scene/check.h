// Check: collects the violations of a scene, or only finds whether there is one.

#ifndef RICOCHET_CORE_SCENE_CHECK_H_
#define RICOCHET_CORE_SCENE_CHECK_H_

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/strings/str_cat.h"
#include "core/base/counted.h"
#include "core/base/decimal.h"
#include "core/contact/scene_contact.h"
#include "core/scene/numbers.h"
#include "ricochet/error.h"

namespace ricochet {

inline bool AllFinite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

// "has 2 entries: must have 1"
inline Violation CountViolation(std::string field, size_t found, size_t wanted) {
  return MakeViolation(std::move(field), absl::StrCat("has ", Counted(found, "entry")), absl::StrCat("have ", wanted));
}

// The paths of the first entries of a list.
inline std::vector<std::string> EntriesOf(const std::string& field, size_t count) {
  std::vector<std::string> entries;
  for (size_t i = 0; i < count; ++i) entries.push_back(absl::StrCat(field, "[", i, "]"));
  return entries;
}

class Check {
 public:
  // kVerdict spares the texts of the violations, because a sweep checks every point.
  enum class Mode { kListing, kVerdict };
  explicit Check(Mode mode) : Check(mode, CountsAll) {}

  // Lists only violations of which `counts` is true. It must outlive the check.
  Check(Mode mode, absl::FunctionRef<bool(const Violation&)> counts) : mode_(mode), counts_(counts) {}

  // `violation()` is called only if the violation may be listed: none is once the list is full.
  template <typename MakesViolation>
  void Require(bool holds, const MakesViolation& violation) {
    if (holds) return;
    failed_ = true;
    if (mode_ == Mode::kVerdict || IsFull()) return;
    Violation found = violation();
    if (counts_(found)) violations_.push_back(std::move(found));
  }

  // A value that is not finite breaks every rule.
  void Number(const NumberPath& path, double value, NumberRule rule) {
    if (!Holds(value, rule)) Broken(path, value, rule);
  }

  void RequireSet(bool is_set, const char* field, const char* rule) {
    Require(is_set, [&] { return MakeViolation(field, "is not set", rule); });
  }

  // Requires that the list has `wanted` entries, and returns whether it has.
  bool Length(const std::string& field, size_t found, size_t wanted) {
    Require(found == wanted, [&] { return CountViolation(field, found, wanted); });
    return found == wanted;
  }

  // True if any rule is broken, whether that is listed or not.
  bool failed() const { return failed_; }
  // True if further violations would not be listed.
  bool IsFull() const { return ricochet::IsFull(violations_); }
  std::vector<Violation> violations() && { return std::move(violations_); }

 private:
  // It takes the path by value and is kept out of line, so that no path is made of a number that keeps its rule.
  [[gnu::noinline]] void Broken(NumberPath path, double value, NumberRule rule) {
    Require(false, [&] {
      return MakeViolation(path.Text(), value, std::isfinite(value) ? RangeOf(rule).words : "be finite");
    });
  }

  static bool CountsAll(const Violation& /*violation*/) { return true; }

  Mode mode_;
  absl::FunctionRef<bool(const Violation&)> counts_;
  bool failed_ = false;
  std::vector<Violation> violations_;
};

// Checks the rules of a system beyond those of its single numbers: which fields are set, the lengths of lists, and
// whether matrices are definite.
void CheckShape(const System& system, Check& check);

// Checks a mechanism whose Jacobian has the rows of so many contacts.
void CheckMechanism(const Mechanism& mechanism, size_t contacts, Check& check);

// Checks the inertia of a body in space about its centre of mass, which is finite: 11, 12, 13, 22, 23, 33.
void CheckInertia(const std::string& field, const std::vector<double>& upper, Check& check);

// True if the damping of a spring takes the place of the coefficient of restitution.
bool HasDamping(const Scene& scene);

// Checks what compliance and finite forces may be combined with.
void CheckEffects(const Scene& scene, Check& check);

// Checks the rules that depend on the contact: impulses move it along n, and the coefficients keep their
// rules at the approach speed. All other rules must hold already. If that takes reducing the scene, `contact` is what
// it was reduced to; `known` is that if the caller has it, else null.
void CheckContact(const Scene& scene, const AnyReduction* known, Check& check, std::optional<SceneContact>& contact);

// Where models multiply entries of W by each other, a diagonal entry is 0 or at least this part of the largest: smaller
// ones would be lost.
inline constexpr double kLeastShareOfW = 0x1p-460;

// Checks one diagonal entry of W, in 1/kg; `field()` names what has it.
template <typename Field>
void RequireShareOfW(double own, double largest, const Field& field, Check& check) {
  check.Require(!(own > 0.0 && own / largest < kLeastShareOfW), [&] {
    return MakeViolation(field(), absl::StrCat("has ", ShortestDecimal(own), " 1/kg on the diagonal of W"),
                         absl::StrCat("have 0 or at least ", ShortestDecimal(kLeastShareOfW), " times the largest, ",
                                      ShortestDecimal(largest)),
                         ViolationKind::kContact);
  });
}

}  // namespace ricochet

#endif  // RICOCHET_CORE_SCENE_CHECK_H_
