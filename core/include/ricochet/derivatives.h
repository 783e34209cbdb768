// Derivatives: how fast a number of an outcome changes with a number of its scene, and where that has no single answer.
//
// An outcome is a piecewise smooth function of its scene. Inside a piece both one-sided derivatives agree. On a
// threshold between two pieces they may differ, or the outcome jumps, so that the derivative on that side does not
// exist. A threshold counts as reached if it lies within 4 ulp of the number that changes.
// The structs mirror ricochet.v1.Derivative. docs/theory/derivatives.md has the formulas and what they are accurate to.

#ifndef RICOCHET_DERIVATIVES_H_
#define RICOCHET_DERIVATIVES_H_

#include <optional>
#include <string>
#include <vector>

#include "ricochet/scene.h"

namespace ricochet {

// The derivatives that a request asks for: of each number of `of` by each of `by`. Neither list may be empty.
struct DerivativePaths {
  // Numbers of the outcome (ricochet/outcome_numbers.h): "impulse.normal_total_n_s".
  std::vector<std::string> of = {};
  // Numbers of the scene, named as the axes of a sweep: "friction.kinetic_coefficient".
  std::vector<std::string> by = {};
  // Also sets Derivative::below and Derivative::above, which takes up to 350 impacts for each number of `by`. Outcomes
  // alone have them.
  bool find_thresholds = false;
  friend bool operator==(const DerivativePaths&, const DerivativePaths&) = default;
};

// The numbers are those of ricochet.v1.Derivative.Kind.
enum class DerivativeKind {
  kUnspecified = 0,
  kTwoSided = 1,  // Both sides agree.
  kOneSided = 2,  // The sides differ, or one of them alone exists.
  kNone = 3,      // No side exists.
};

// A Threshold lies at the number itself, so that its two sides are not alike. The numbers are those of
// ricochet.v1.Derivative.Threshold.
enum class Threshold {
  kUnspecified = 0,
  kApproach = 1,        // The contact neither approaches nor separates before the impact.
  kSlipStart = 2,       // Before the impact there is no slip: it would start in either direction.
  kFrictionLimit = 3,   // Where slip stops, friction only just holds the contact: it sticks or slips on.
  kJamming = 4,         // The contact only just locks or jams.
  kCompressionEnd = 5,  // Slip stops exactly where compression ends.
  kImpactEnd = 6,       // Slip stops exactly where the impact ends.
  kRank = 7,            // W has a lower rank here than beside, or the velocity lies in its range here alone.
  kSpeedTable = 8,      // The approach speed is one that a table by speed lists.
  kDomain = 9,          // The number cannot be lower, or cannot be higher.
  kOther = 10,          // The course of the impact changes in another way.
  kEndRecedes = 11,     // In space: the impact only just ends before EventKind::kEndRecedes.
};

// Says where the impact takes another course, so that a derivative holds no longer.
struct NearThreshold {
  Threshold threshold = Threshold::kUnspecified;
  // The number of the scene may move this far before it, >= 0, in its unit; see ricochet.v1.Derivative.Near.
  double distance = 0.0;
  friend bool operator==(const NearThreshold&, const NearThreshold&) = default;
};

struct Derivative {
  std::string of, by;
  DerivativeKind kind = DerivativeKind::kUnspecified;
  std::optional<double> value;  // Set exactly if both sides agree.
  // The limits of the difference quotient from either side; set where they exist.
  std::optional<double> from_below, from_above;
  Threshold threshold = Threshold::kUnspecified;  // Unspecified if both sides agree.
  // The estimated error of `value` or of both sides; unset if they are exact to rounding, or if no side exists.
  std::optional<double> error;
  std::string reason;  // A sentence that says why a side does not exist; else empty.
  // The nearest threshold that was found if the number of the scene falls, and if it rises. Unset if not asked for, and
  // if there is none up to 1024 times the size of the number. The search tries distances that grow by 1.4 each, from
  // 2^-48 times the size on: a course that lies between two of them is not seen.
  std::optional<NearThreshold> below, above;
  friend bool operator==(const Derivative&, const Derivative&) = default;
};

// Returns the part of the scene that leaves only differences with an estimated error, "an impact in space"; null if its
// derivatives are exact to rounding. Differences take dozens of impacts for each number of the scene.
const char* WhyNotExact(const Scene& scene);

}  // namespace ricochet

#endif  // RICOCHET_DERIVATIVES_H_
