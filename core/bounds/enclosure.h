// Enclosures: the range of each coefficient over all scenes of a box of parameters, proved to contain it.
//
// For every scene in the box the bounds of its coefficients (core/bounds/contact_bounds.h, core/bounds/pendulum_bounds.h:
// the energetic coefficient from 0 to 1) lie within `outer`. That holds in spite of rounding: every operation is
// rounded outward (core/numerics/interval.h). `attained` lies within what scenes of the box reach, also in spite of
// rounding, so the true range lies between the two and `excess` bounds how much too wide `outer` can be.
//
// Pendulum: with q = mu |b| and x = q/a, each end is monotone, or convex, in each parameter, so that it is reached at a
// corner of the box, and `outer` is exact but for rounding:
//   Newton    sqrt((a - q)/(a + q))                     falls with x
//   Poisson   sqrt((a + q)/(a - q))                     grows with x
//   mu_hat    -mu x/(1 + sqrt(1 - x^2)) ... mu          its low end falls with mu and x; mirrored for b < 0
//   tau0      -J w-/(a + q)                             grows with J, |w-|; falls with a, q
//   tau_e     -J w- (1/(a + q) + 1/sqrt(a^2 - q^2))     grows with J, |w-|; falls with a; convex in q
// Where a box reaches from slip into locking the suprema of Poisson's coefficient and of tau_e are infinite.
//
// Planar: branch and bound. With s = sgn(u0), p = |u0|, w = -v0, q = s Wtn, and the slopes of v before and after slip
// has stopped, A1 = Wnn - mu q and A2, everything depends on two numbers: rho = A2/A1 and sigma = v_s/w, v_s being the
// normal velocity where slip stops, 1 + sigma = (A1/B)(p/w), B = mu Wtt - q. In an elastic impact, -1 <= sigma <= 1:
//   e^2 = sigma^2 + rho (1 - sigma^2)
//   k = (1 + sigma e)/(sigma + e), sigma >= 0;   k = e/(rho (1 - m) + m), m = -sigma >= 0
// and e = k = 1 for sigma > 1: slip does not stop. (A1 <= 0, self-locking: core/bounds/planar_ends.cc.) Where a box holds
// scenes of several regimes, all of them are evaluated and joined. The box is cut, the worst part first and across the
// dimension that helps most, until the excess is within the tolerance or the budget is spent. A part whose scenes all
// go the same way is enclosed to first order too (core/bounds/one_regime_ends.cc), so that W and the velocities may
// depend on the same parameters.
//
// Scenes of a box that validation would refuse (det W < 0, mu_s < mu, v0 and u0 outside the range of a W of rank one)
// count for nothing. Scenes that separate count for tau1 = 0 alone. Where a box comes near det W = 0 the true range of
// tau1 itself may be infinite.

#ifndef RICOCHET_CORE_BOUNDS_ENCLOSURE_H_
#define RICOCHET_CORE_BOUNDS_ENCLOSURE_H_

#include <cstdint>
#include <optional>
#include <variant>

#include "absl/functional/function_ref.h"
#include "absl/types/span.h"
#include "core/numerics/interval.h"
#include "core/numerics/slope_form.h"
#include "ricochet/bounds.h"

namespace ricochet {

// Units as in core/models/planar/planar.h.
struct PlanarBox {
  Interval wtt, wtn, wnn;
  Interval u0, v0;
  Interval mu;
  std::optional<Interval> mu_static;  // As kinetic if unset.
  // C = Wnn - Wtn^2/Wtt = det W/Wtt, where more is known of it than from the entries.
  std::optional<Interval> stick_slope;
};

// The same to first order in the parameters of the box.
struct PlanarForm {
  SlopeForm wtt, wtn, wnn;
  SlopeForm u0, v0;
  SlopeForm mu;
  std::optional<SlopeForm> mu_static;
  std::optional<SlopeForm> stick_slope;
};

// Units as in core/models/pendulum/pendulum.h. The same static and kinetic friction if `mu_static` is unset.
struct PendulumBox {
  Interval inertia, a, b, omega_minus;
  Interval mu;
  std::optional<Interval> mu_static;
  std::optional<Interval> slope;  // b/a, where more is known of it than from the two.
};

// Says that nobody waits for the answer any more.
using Stopped = absl::FunctionRef<bool()>;

struct EnclosureOptions {
  double tolerance = 0.005;  // Wanted: excess <= tolerance.
  int64_t budget = 200'000;  // Boxes evaluated, at the most (but one is in any case); some 2 to 10 us each.
};

Enclosure Enclose(const PendulumBox& box);

Enclosure Enclose(const PlanarBox& box, const EnclosureOptions& options);

// `to_box` encloses the contact or the pendulum (a of either sign) that a system's scenes come to, for every scene
// whose parameters lie in the intervals that it is given; the narrower they are, the narrower must its answer be. Where
// no scene is valid its mu may be empty. `ranges` are the whole box. Branch and bound for both.
// `stopped` is asked every kBoxesUnasked boxes; once it says yes the answer is what the boxes until then prove.
using ToBox = absl::FunctionRef<std::variant<PlanarForm, PendulumBox>(absl::Span<const Interval> ranges)>;
inline constexpr int64_t kBoxesUnasked = 256;
Enclosure Enclose(absl::Span<const Interval> ranges, ToBox to_box, const EnclosureOptions& options, Stopped stopped);

}  // namespace ricochet

#endif  // RICOCHET_CORE_BOUNDS_ENCLOSURE_H_
