// Planar: one frictional impact at one point of any planar system, event by event, exact: no step size.
//
// All that a multibody system knows of the impact is its contact-space inverse inertia (Delassus matrix)
// W = [Wtt, Wtn; Wtn, Wnn] = J M^-1 J^T, symmetric positive semidefinite, and the approach velocity (u0, v0), v0 < 0.
// Routh (1905), Keller (1986), Wang and Mason (1992); with the normal impulse tau as the independent variable:
//
//   d(u, v)/dtau = W (f', 1),   f' = -mu sgn(u) while the contact slips, |f'| <= mu_s while it sticks
//
// At u = 0 the contact sticks, f' = -Wtn/Wtt, if |Wtn| <= mu_s Wtt; else slip starts towards sgn(Wtn). u and v are
// piecewise linear in tau. Compression ends at v = 0. v may fall at first (self-locking): then compression goes on
// until slip has stopped. Restitution ends at
//   Newton     v = -e v0
//   Poisson    tau1 = (1 + k) tau_c
//   energetic  normal work of restitution = -eta^2 times that of compression
// Newton's and Poisson's laws may ask for energy that was never stored: computed as asked, and flagged.
//
// Regimes, the first that applies:
//   separating    v0 >= 0: nothing changes
//   locked        W has rank one and the contact sticks: u and v vanish together, no restitution, coefficients 0
//   frictionless  no friction impulse is possible: mu_s = 0, or Wtt = 0, or mu = 0 and the contact never sticks
//   stick / reversal in compression   slip stops (or u0 = 0 and the contact sticks) before v = 0
//   stick / reversal in restitution   slip stops later; also where it stops exactly at v = 0, as that of every pendulum
//                                     does, or exactly where restitution ends
//   sliding       slip never stops, or u0 = 0 and slip starts
//
// Rank one: |det W| <= 4 eps Wtt Wnn, eps = 2^-52, which is how far rounding takes the W of a pendulum. Wnn and Wtn are
// then taken at their word, Wtt as Wtn^2/Wnn and u as v Wtn/Wnn, so that u and v vanish together whatever the rounding;
// the contact sticks if Wnn <= mu_s |Wtn|. Wtt = 0 (then Wtn = 0): f' = 0 and u = u0.
//
// Accuracy: each output within 1 ulp of the exact value of the exact inputs over the whole double range, or 2^-94 c of
// its scale where that is more: max(|u0|, |v0|) for velocities, tau1 for normal impulses, tau1 times the largest |f'|
// for tangential ones, the largest work for works and energy. The sign of every slope is exact. v where slip stops is
// right to 2^-100 of v0; the stick that follows divides by v' = det W/Wtt, hence
// c = (Wtt Wnn/det W) (1 + mu |Wtn|/Wnn), at rank one 1. Slip that stops closer than that to where a phase ends may be
// given to either phase. A gain of energy, or an excess over the sharp limit, below 2^-96 of its terms counts as 0.
// An exact value above the largest double comes out infinite.
// Bad input: none gets here (core/scene/validate.h). That includes a rank-one W whose range (u0, v0) is not in.

#ifndef RICOCHET_CORE_MODELS_PLANAR_PLANAR_H_
#define RICOCHET_CORE_MODELS_PLANAR_PLANAR_H_

#include <array>
#include <cstdint>

#include "core/models/impact_end.h"
#include "core/models/restitution_law.h"
#include "ricochet/outcome.h"

namespace ricochet::planar {

struct Problem {
  double wtt = 0.0;  // 1/kg, >= 0
  double wtn = 0.0;
  double wnn = 0.0;  // > 0
  double u0 = 0.0;   // m/s
  double v0 = 0.0;   // m/s; >= 0 is separating
  double mu = 0.0;
  double mu_static = 0.0;  // mu_s >= mu
  RestitutionLaw law = RestitutionLaw::kEnergetic;
  double coefficient = 0.0;  // e, k or eta
};

using Instant = ImpactInstant<double>;

// The start, the stop of slip, the ends of compression and of restitution.
inline constexpr int kMaxEvents = 4;

// The excess is free of cancellation: > 0 exactly if the sharp limit is broken. The change of energy is p . (v- +
// v+)/2, never through an inverse of W.
struct Impact : ImpactEnd<double> {
  double f_compression = 0.0;
  std::array<Instant, kMaxEvents> events;  // In order of tau; u is linear between them, and so are v and f.
  int event_count = 0;                     // 0 where separating.
};

Impact Solve(const Problem& problem);

// The contact at normal impulse tau in [0, tau1] of `impact`, which must be that of `problem`; kind is unspecified.
// Accuracy: 4 ulp of the largest value at the events, and what an ulp of tau makes. Separating: nothing has changed.
Instant At(const Problem& problem, const Impact& impact, double tau);

}  // namespace ricochet::planar

#endif  // RICOCHET_CORE_MODELS_PLANAR_PLANAR_H_
