// Planar: one frictional impact at one point of any planar system, event by event, exact: there is no step size.
//
// The problem is the Delassus matrix W = [Wtt, Wtn; Wtn, Wnn] = J M^-1 J^T and the approach velocity (u0, v0), v0 < 0.
// With the normal impulse tau as the independent variable (Routh 1905, Keller 1986, Wang and Mason 1992),
//
//   d(u, v)/dtau = W (f', 1),   f' = -mu sgn(u) while the contact slips, |f'| <= mu_s while it sticks
//
// Compression ends at v = 0, restitution as the law of restitution says. Newton's and Poisson's laws may ask for energy
// that was never stored; the impact is then computed as asked, and flagged. docs/theory/planar.md defines the
// regimes. Each output is within 1 ulp of its exact value over the whole range of doubles, except outputs that cancel
// (docs/theory/planar_numerics.md). The sign of every slope is exact. An exact value above the largest double comes out
// infinite.
// If W has rank one and (u0, v0) lies beside its range, a contact that sticks keeps its v. It jams where that does not
// end the impact: the regime is wedged, the termination refused, and the result is the state reached. The problem must
// be valid (core/scene/validate.h).

#ifndef RICOCHET_CORE_MODELS_PLANAR_PLANAR_H_
#define RICOCHET_CORE_MODELS_PLANAR_PLANAR_H_

#include <algorithm>
#include <array>

#include "core/models/impact_end.h"
#include "core/models/impact_errors.h"
#include "core/models/planar_problem.h"
#include "ricochet/outcome.h"

namespace ricochet::planar {

using Problem = PlanarProblem;

using Instant = ImpactInstant<double>;

// The events are the start, the stop of slip, the end of compression and the end of restitution.
inline constexpr int kMaxEvents = 4;

// The energetic excess is computed without cancellation, so that it is > 0 exactly if the sharp limit is broken.
struct Impact : ImpactEnd<double> {
  double f_compression = 0.0;
  std::array<Instant, kMaxEvents> events;  // In order of tau; u, v and f are linear between two events.
  int event_count = 0;                     // 0 if the contact separates.
};

// Bounds on the errors of an impact that rounding makes; W, the velocity before and the coefficients are taken as
// exact.
struct RoundingErrors {
  double velocity = 0.0;  // Each component of the velocity after, over V = max(|u0|, |v0|).
  double impulse = 0.0;   // Each impulse times its mobility, Wnn |d tau| and Wtt |d f|, over V.
  double work = 0.0;      // Each work and the change of energy, over the sum of the magnitudes of the four works.
  // This is `impulse` as it counts beside the others: in double-double arithmetic it is relative to the larger of V and
  // Wnn tau, Wtt |f|. If W is nearly singular, impulses are large, and their last digit alone exceeds V.
  double counted_impulse = 0.0;

  double Largest() const { return std::max({velocity, counted_impulse, work}); }
};

// Solves in double-double arithmetic. `numbers` receives the error of each number on its own scale, unless it is null.
Impact Solve(const Problem& problem);
Impact Solve(const Problem& problem, RoundingErrors& errors, ImpactErrors* numbers = nullptr);

// An impact in plain double arithmetic.
struct PlainImpact {
  Impact impact;
  RoundingErrors errors;
  // False if plain arithmetic cannot prove a sign that decides on the regime, on the order of the events or on a broken
  // limit, or if a number other than 0 lies outside [2^-40, 2^40], u0 or Wtn outside [2^-100, 2^40]. The rest has no
  // meaning then.
  bool proved = false;
};

// SolvePlain computes the impact at a fifth of the cost of Solve. Regime, events and broken limits are those of Solve
// if they are proved. docs/theory/rounding_planar.md derives the bounds, and those on the coefficients that follow from
// them.
PlainImpact SolvePlain(const Problem& problem, ImpactErrors* numbers = nullptr);

// The state of the contact at normal impulse tau in [0, tau1]. `impact` must be the solution of `problem`; the kind of
// the instant is unspecified. If the contact separates, the state is that before the impact. Accuracy: 4 ulp of the
// largest value at the events, plus the effect of an ulp of tau.
Instant At(const Problem& problem, const Impact& impact, double tau);

}  // namespace ricochet::planar

#endif  // RICOCHET_CORE_MODELS_PLANAR_PLANAR_H_
