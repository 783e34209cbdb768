// Reduce: the contact (core/contact/reduction.h) of every scene of a box, enclosed in intervals.
//
// Entries are forms to first order in the parameters of the box (core/numerics/affine_interval.h). Every operation is
// rounded outward, so they contain the exact contact of every scene. They are too wide by at most the square of the
// box's size; those of a pendulum are no wider than they must be. `stick_slope` is C = Wnn - Wtn^2/Wtt = det W/Wtt in a
// form without that difference, because the entries of W alone cannot tell a W of full rank from others.
// docs/theory/bounds.md has the formulas. Bad input: none gets here (core/answer/scene_enclosure.h).

#ifndef RICOCHET_CORE_CONTACT_INTERVAL_REDUCTION_H_
#define RICOCHET_CORE_CONTACT_INTERVAL_REDUCTION_H_

#include <optional>
#include <variant>

#include "absl/functional/function_ref.h"
#include "core/numerics/affine_interval.h"
#include "core/numerics/interval.h"
#include "ricochet/scene.h"

namespace ricochet {

// The scenes each of whose numbers lies between the one in `low` and the one in `high`. Only numbers differ in the two.
struct SceneBox {
  Scene low;
  Scene high;
  std::optional<Interval> phi;  // A pendulum's angle: a = R sin(phi), b = R cos(phi), R = sqrt(a^2 + b^2) of `low`.
};

struct IntervalPendulum {
  Interval inertia, a, b;         // `a` may have either sign, and is empty if no pendulum of the box has an a > 0.
  std::optional<Interval> slope;  // b/a, set if more is known of it than a and b tell.
  Interval omega_minus;
};

struct AffineContact {
  AffineInterval wtt, wtn, wnn;
  AffineInterval stick_slope;  // C
  AffineInterval u0, v0;       // The velocity relative to the surface.
};

using IntervalReduction = std::variant<IntervalPendulum, AffineContact>;

// Tells whether the system's W has rank one by construction: a pendulum, or a linkage of one link.
bool IsOfRankOne(const System& system);

// The scenes must state a planar system, and a surface at rest if IsOfRankOne. The numbers that differ become
// `parameters`. `stopped` is asked before each row of a linkage's elimination, which for 64 links takes some 20 ms;
// once it returns true the answer means nothing.
IntervalReduction Reduce(const SceneBox& box, SlopeParameters& parameters, absl::FunctionRef<bool()> stopped);

}  // namespace ricochet

#endif  // RICOCHET_CORE_CONTACT_INTERVAL_REDUCTION_H_
