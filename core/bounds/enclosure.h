// Enclose: the range of each coefficient over all scenes of a box of parameters, proved to contain it.
//
// For every scene of the box the bounds of its coefficients (core/bounds/contact_bounds.h,
// core/bounds/pendulum_bounds.h) lie within `outer`, in spite of rounding: every operation is rounded outward
// (core/numerics/interval.h). `attained` lies within what scenes of the box reach, also in spite of rounding. The true
// range lies between the two, and `excess` bounds by how much `outer` is too wide. Scenes that validation would refuse
// (det W < 0, mu_s < mu) and impacts that jam count for nothing; scenes that separate count only for tau1 = 0. Where a
// box reaches into locking, or near det W = 0, the true suprema of Poisson's coefficient and of tau1 may be infinite. A
// pendulum's box is solved at its corners, any other by branch and bound.
// docs/theory/bounds.md has the derivation.

#ifndef RICOCHET_CORE_BOUNDS_ENCLOSURE_H_
#define RICOCHET_CORE_BOUNDS_ENCLOSURE_H_

#include <cstdint>
#include <optional>
#include <variant>

#include "absl/functional/function_ref.h"
#include "absl/types/span.h"
#include "core/numerics/affine_interval.h"
#include "core/numerics/interval.h"
#include "ricochet/bounds.h"

namespace ricochet {

// The contacts of a box over a type of intervals. Units as in core/models/planar/planar.h.
template <typename N>
struct PlanarBoxOf {
  N wtt, wtn, wnn;
  N u0, v0;
  N mu;
  std::optional<N> mu_static;  // The kinetic coefficient if unset.
  // C = Wnn - Wtn^2/Wtt = det W/Wtt, set if more is known of C than the entries of W tell.
  std::optional<N> stick_slope;
};
using PlanarBox = PlanarBoxOf<Interval>;
using AffinePlanarBox = PlanarBoxOf<AffineInterval>;  // To first order in the parameters of the box.

// Units as in core/models/pendulum/pendulum.h.
struct PendulumBox {
  Interval inertia, a, b, omega_minus;
  Interval mu;
  std::optional<Interval> mu_static;  // The kinetic coefficient if unset.
  std::optional<Interval> slope;      // b/a, set if more is known of it than a and b tell.
};

// Says that nobody waits for the answer any more, and goes on saying so.
using Stopped = absl::FunctionRef<bool()>;

struct EnclosureOptions {
  double tolerance = 0.005;  // The search ends once excess <= tolerance.
  int64_t budget = 200'000;  // The most boxes that are evaluated, >= 1; each takes some 2 to 10 us.
};

Enclosure Enclose(const PendulumBox& box);

// Gives the contact, or the pendulum (a of either sign), of all scenes whose parameters lie in `ranges`: the answer
// must contain each of theirs, and must shrink with the ranges. If no scene is valid, mu may be empty.
using ToBox = absl::FunctionRef<std::variant<AffinePlanarBox, PendulumBox>(absl::Span<const Interval> ranges)>;

// Encloses the scenes whose parameters lie in `ranges`, by branch and bound. `stopped` is asked before each box; once
// it says true the answer is what the boxes until then prove.
Enclosure Enclose(absl::Span<const Interval> ranges, ToBox to_box, const EnclosureOptions& options, Stopped stopped);

}  // namespace ricochet

#endif  // RICOCHET_CORE_BOUNDS_ENCLOSURE_H_
