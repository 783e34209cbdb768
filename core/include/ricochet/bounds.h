// Bounds: which values the coefficients of an impact can take, whatever its restitution.
//
// The structs mirror ricochet.v1.BoundsResponse field by field. For a pendulum over a surface at rest, with
// x = mu |b|/a < 1 and r = (1-x)/(1+x), they are those of Lubarda (2009):
//   sharp        0 <= Newton <= sqrt(r), 0 <= Poisson <= 1/sqrt(r), 0 <= eta <= 1          [29], [30]
//                tau0 <= tau1 <= (1 + 1/sqrt(r)) tau0                                      [31]
//                -(a/|b|)(1 - sqrt(1 - x^2)) <= mu_hat <= mu                               [55]
//   energy only  Newton <= 1, Poisson <= 1/r, from E+ <= E- alone                          [27], [28]
//   first order  Newton <= 1 - x, Poisson <= 1 + x, mu_hat >= -mu x/2                      [57], [58], [60]
// docs/theory/bounds.md has the bounds of any other planar contact, and says which bounds are answered in space.
// Impulses are in N s.

#ifndef RICOCHET_BOUNDS_H_
#define RICOCHET_BOUNDS_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/outcome.h"
#include "ricochet/system.h"

namespace ricochet {

// A closed interval.
struct Range {
  double lower = 0.0;
  double upper = 0.0;
  friend bool operator==(const Range&, const Range&) = default;
};

struct CoefficientBounds {
  Range newton;
  Range poisson;
  Range energetic;
  Range tangential;        // Brach's mu_hat; for b < 0 the range is mirrored.
  Range normal_total_n_s;  // tau1; [0, 0] if the contact separates.
  friend bool operator==(const CoefficientBounds&, const CoefficientBounds&) = default;
};

// NearlyVertical holds the paper's forms for a nearly vertical impact, which are of first order in x, and how far from
// the exact value each may lie. The errors hold for every x < 1 and are derived in docs/theory/bounds.md.
struct NearlyVertical {
  CoefficientBounds bounds;   // [57], [58], [60]
  double newton_error = 0.0;  // |bounds.newton.upper - exact value| is at most this; likewise for the others.
  double poisson_error = 0.0;
  double tangential_error = 0.0;
  double normal_total_error_n_s = 0.0;
  std::optional<Coefficients> coefficients;  // [56], [59] at the scene's restitution; absent if the scene states none.
  Coefficients coefficient_errors;           // |coefficients - exact values| are at most these.
  friend bool operator==(const NearlyVertical&, const NearlyVertical&) = default;
};

// Each critical coefficient of friction is the one from which on the impact behaves as said below. Static and kinetic
// friction are taken equal, and everything else is as in the scene. A member is absent if no friction has that effect,
// if the contact separates, and for systems in space.
struct CriticalFriction {
  std::optional<double> stick;  // From here on a contact that has stopped sticks; a pendulum locks, at a/|b|.
  std::optional<double> stop_compression;  // Above this, slip stops before compression ends.
  std::optional<double> stop;              // Above this, slip stops before an elastic impact ends.
  std::optional<double> reversal;          // From here up to `stick`, slip reverses in an elastic impact.
  std::optional<double> jam;               // Above this, the contact jams: sliding at first makes v decrease, v' < 0.
  friend bool operator==(const CriticalFriction&, const CriticalFriction&) = default;
};

struct Bounds {
  // The regime is that of the elastic impact, whose path contains the path of every other impact. For a pendulum over a
  // surface at rest it is kFrictionless, kRebound, kLocked or kSeparating.
  Regime regime = Regime::kUnspecified;
  // Only a pendulum over a surface at rest has these two ratios. For all others both are 0, which no pendulum has.
  double friction_ratio = 0.0;                   // x = mu |b|/a, the energy ratio of [42].
  double slope_ratio = 0.0;                      // r = (a - mu|b|)/(a + mu|b|), negative above the locking threshold.
  CoefficientBounds sharp;                       // Solve answers each end with an admissible outcome, unless `sampled`.
  std::optional<CoefficientBounds> energy_only;  // Weaker bounds, from kinetic energy alone. Absent in space.
  std::optional<NearlyVertical> nearly_vertical;  // Present for a pendulum over a surface at rest that does not lock.
  CriticalFriction critical;
  bool sampled = false;  // In space `sharp` is what a sample of impacts reaches (docs/theory/bounds.md).
  friend bool operator==(const Bounds&, const Bounds&) = default;
};

// Returns the paths of the numbers that have derivatives: the ends of `sharp`, and for systems in a plane those of
// `energy_only` and `critical`; "sharp.newton.upper".
std::vector<std::string> BoundsNumbers(const System& system);

// Returns the number at a path; nothing if it is unset or there is no such path.
std::optional<double> BoundsNumber(const Bounds& bounds, const std::string& path);

// An Enclosure contains the coefficients of every scene whose uncertain fields lie in their ranges.
// docs/theory/bounds.md has the proof.
struct Enclosure {
  CoefficientBounds outer;  // Ranges that are proved to contain; an end is infinite if no bound exists or was found.
  // Scenes in the ranges reach both ends of each of these; `energetic` alone is a copy of that in `outer`. Both members
  // are empty (lower > upper) if no scene is valid.
  CoefficientBounds attained;
  // The largest of (width of outer - width of attained)/(width of attained) over the coefficients. An end that differs
  // by rounding alone counts as 0, and an infinite range makes the excess infinite.
  double excess = 0.0;
  int64_t boxes = 0;  // Number of boxes that were evaluated.
  friend bool operator==(const Enclosure&, const Enclosure&) = default;
};

}  // namespace ricochet

#endif  // RICOCHET_BOUNDS_H_
