// Sliding: the impact whose slip neither stops nor turns, and the one without friction, in plain double arithmetic.
//
// From W, the contact velocity before the impact, mu and the coefficient of restitution, in a plane and in space, Solve
// follows slip along e = u0/|u0| (in a plane sgn u0). The path is one straight line in the normal impulse, on which the
// three definitions of restitution are the same:
//   f' = -mu e,  v' = Wnn - mu wtn . e,  u' = wtn - mu Wtt e,  tau_c = -v0/v',  tau1 = (1 + c) tau_c
// SolveFrictionless reads neither mu nor, but for the rank of W, Wtt. A W of rank one is taken at its word.
// Units: SI. Accuracy: some roundings; ErrorsOf and FrictionlessErrorsOf have proved bounds.
// Bad input: none gets here. The caller has made sure of v0 < 0 and 0 <= c <= 1, and with friction of u0 != 0, mu > 0,
// v' > 0, and that slip does not stop nor turn by more than it allows (core/plan/).
// Source: Routh (1905), Keller (1986). docs/theory/sliding.md has the equations and the proof of the bounds.

#ifndef RICOCHET_CORE_MODELS_SLIDING_SLIDING_H_
#define RICOCHET_CORE_MODELS_SLIDING_SLIDING_H_

#include <array>
#include <cstddef>

#include "core/models/impact_end.h"
#include "core/models/impact_errors.h"
#include "ricochet/outcome.h"

namespace ricochet::sliding {

template <size_t kTangential>
using Vector = std::array<double, kTangential>;

template <size_t kTangential>
struct Problem {
  static_assert(kTangential == 1 || kTangential == 2);
  static constexpr size_t kDirections = kTangential + 1;  // The last one is n.

  std::array<double, kDirections*(kDirections + 1) / 2> w = {};  // 1/kg, upper triangle row by row
  Vector<kTangential> u0 = {};                                   // m/s
  double v0 = 0.0;                                               // m/s
  double mu = 0.0;
  double coefficient = 0.0;  // by all three definitions of restitution

  double Wnn() const { return w.back(); }
  // The trace of Wtt, which no tangential mobility exceeds.
  double Wtt() const { return kTangential == 1 ? w[0] : w[0] + w[3]; }
  Vector<kTangential> Wtn() const {
    if constexpr (kTangential == 1) {
      return {w[1]};
    } else {
      return {w[2], w[4]};
    }
  }
};

// Slopes of u, v and f over the normal impulse.
template <size_t kTangential>
struct Slopes {
  Vector<kTangential> u;
  double v;
  Vector<kTangential> f;
};

// The slopes of slip along u0.
template <size_t kTangential>
Slopes<kTangential> SlidingSlopes(const Problem<kTangential>& problem);

// Bounds on the errors of Solve and of SolveFrictionless; infinite where v' is mostly rounding, or beyond a range: an
// entry of W, mu or the coefficient is 0 or lies in [2^-100, 2^100], the largest velocity, and the largest slip if
// there is friction, in [2^-900, 2^100].
template <size_t kTangential>
RelativeErrors ErrorsOf(const Problem<kTangential>& problem);
template <size_t kTangential>
RelativeErrors FrictionlessErrorsOf(const Problem<kTangential>& problem);

template <size_t kTangential>
using Instant = ImpactInstant<Vector<kTangential>>;

// The sharp limit is never broken, because c <= 1. The limits of friction and of energy are broken only where the
// caller excludes that slip stops: friction then drives slip backwards, and may give more energy than restitution
// takes.
template <size_t kTangential>
struct Impact : ImpactEnd<Vector<kTangential>> {
  std::array<Instant<kTangential>, 3> events = {};  // the start, the ends of compression and of restitution
  int event_count = 3;
};

template <size_t kTangential>
Impact<kTangential> Solve(const Problem<kTangential>& problem);
// True if slip would reverse so far that friction along the first slip does positive work.
template <size_t kTangential>
bool FrictionPushes(const Problem<kTangential>& problem);
template <size_t kTangential>
Impact<kTangential> SolveFrictionless(const Problem<kTangential>& problem);

// Bounds on the errors of the numbers of either impact, each on its own scale, in the same range.
template <size_t kTangential>
ImpactErrors NumberErrorsOf(const Problem<kTangential>& problem, const Impact<kTangential>& impact);

// The contact at normal impulse tau in [0, tau1] of either impact, with an unspecified kind.
// Accuracy: 4 ulp of the largest value at the events.
template <size_t kTangential>
Instant<kTangential> At(const Impact<kTangential>& impact, double tau);

}  // namespace ricochet::sliding

#endif  // RICOCHET_CORE_MODELS_SLIDING_SLIDING_H_
