// Bounds: which values the coefficients of an impact can take, whatever its restitution.
//
// Mirrors ricochet.v1.BoundsResponse field by field. With x = mu |b|/a < 1 and r = (1-x)/(1+x), Lubarda (2009):
//   sharp        0 <= Newton <= sqrt(r), 0 <= Poisson <= 1/sqrt(r), 0 <= eta <= 1          [29], [30]
//                tau0 <= tau1 <= (1 + 1/sqrt(r)) tau0                                      [31]
//                -(a/|b|)(1 - sqrt(1 - x^2)) <= mu_hat <= mu                               [55]
//   energy only  Newton <= 1, Poisson <= 1/r, from E+ <= E- alone                          [27], [28]
//   first order  Newton <= 1 - x, Poisson <= 1 + x, mu_hat >= -mu x/2                      [57], [58], [60]
// That is a pendulum over a surface at rest. core/bounds/contact_bounds.h has the bounds of any other planar contact,
// core/answer/scene_bounds.h says which are answered in space.

#ifndef RICOCHET_BOUNDS_H_
#define RICOCHET_BOUNDS_H_

#include <cstdint>
#include <optional>

#include "ricochet/outcome.h"

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
  Range tangential;        // Brach's mu_hat, mirrored for b < 0.
  Range normal_total_n_s;  // tau1; [0, 0] where the contact separates.
  friend bool operator==(const CoefficientBounds&, const CoefficientBounds&) = default;
};

// The forms for a nearly vertical impact, first order in x, and how far from the exact value each may lie.
// The errors hold for every x < 1 and are derived in core/bounds/nearly_vertical.h.
struct NearlyVertical {
  CoefficientBounds bounds;   // [57], [58], [60]
  double newton_error = 0.0;  // |bounds.newton.upper - exact| <= this, and so on.
  double poisson_error = 0.0;
  double tangential_error = 0.0;
  double normal_total_error_n_s = 0.0;
  std::optional<Coefficients> coefficients;  // [56], [59] at the scene's restitution; absent where it states none.
  Coefficients coefficient_errors;           // |coefficients - exact| <= these.
  friend bool operator==(const NearlyVertical&, const NearlyVertical&) = default;
};

// From which coefficient of friction on, static and kinetic taken equal, what happens; all else as in the scene.
// Absent where no friction does that, where the contact separates, and for systems in space.
struct CriticalFriction {
  std::optional<double> stick;             // Contact that has stopped sticks; a pendulum locks, at a/|b|.
  std::optional<double> stop_compression;  // Above: slip stops before compression ends.
  std::optional<double> stop;              // Above: slip stops before an elastic impact ends.
  std::optional<double> reversal;          // From here up to `stick` slip reverses in an elastic impact.
  std::optional<double> jam;               // Above: sliding drives the contact in at first, v' < 0.
  friend bool operator==(const CriticalFriction&, const CriticalFriction&) = default;
};

struct Bounds {
  // Of the elastic impact, which goes through all that the others do; of a pendulum over a surface at rest
  // kFrictionless, kRebound, kLocked or kSeparating.
  Regime regime = Regime::kUnspecified;
  // Of a pendulum over a surface at rest; for others both are 0, which no pendulum has.
  double friction_ratio = 0.0;                    // x = mu |b|/a, the energy ratio of [42].
  double slope_ratio = 0.0;                       // r = (a - mu|b|)/(a + mu|b|), negative above the locking threshold.
  CoefficientBounds sharp;                        // Fed back to Solve, each end is admissible; but where `sampled`.
  std::optional<CoefficientBounds> energy_only;   // Weaker: what kinetic energy alone allows. Absent in space.
  std::optional<NearlyVertical> nearly_vertical;  // Of a pendulum over a surface at rest that does not lock.
  CriticalFriction critical;
  bool sampled = false;  // `sharp` is what a sample of impacts reaches: in space (core/answer/scene_bounds.h).
  friend bool operator==(const Bounds&, const Bounds&) = default;
};

// What an uncertain scene's coefficients can be; core/bounds/enclosure.h has the proof.
struct Enclosure {
  CoefficientBounds outer;  // Proved to contain. Infinite ends: no bound exists, or none was found.
  // Reached by scenes of the box; but for `energetic`, which is as in `outer`. Both are empty (lower > upper) if no
  // scene is valid.
  CoefficientBounds attained;
  // The largest of (width of outer - width of attained)/(width of attained) over the coefficients; an end that rounding
  // alone moves counts as 0, and a range that is infinite as infinite.
  double excess = 0.0;
  int64_t boxes = 0;  // Evaluated.
  friend bool operator==(const Enclosure&, const Enclosure&) = default;
};

}  // namespace ricochet

#endif  // RICOCHET_BOUNDS_H_
