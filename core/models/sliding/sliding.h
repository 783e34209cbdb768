// Sliding: the impact whose slip neither stops nor turns, and the one without friction, in plain double arithmetic.
//
// Routh (1905), Keller (1986). With W, (u0, v0) and mu as in core/models/planar/planar.h and core/models/spatial/spatial.h, and
// e = u0/|u0| (in a plane sgn u0), slip that keeps its direction makes the whole path one straight line:
//
//   f' = -mu e                               friction per normal impulse
//   v' = Wnn - mu wtn . e,   v' > 0          and  u' = wtn - mu Wtt e
//   tau_c = -v0/v',   tau1 = (1 + c) tau_c   the three laws are one, c their common coefficient
//   u1 = u0 + u' tau1,   v1 = -c v0,   f1 = -mu tau1 e
//   Wc_n = tau_c v0/2,   Wr_n = -c^2 Wc_n,   works of friction: f (u at both ends)/2 of each phase
//   dE = (f1 . (u0 + u1) + tau1 (v0 + v1))/2
//
// Without friction f = 0, u' = wtn and v' = Wnn: that has functions of its own, which read neither mu
// nor, but for the rank of W, Wtt.
// W is taken at its word: where it has rank one, core/models/planar/planar.h puts v0 wtn/Wnn in place of a u0 that rounding
// has moved from there, and these functions do not.
//
// Accuracy: plain doubles, rounded to nearest, eps = 2^-53. Proof of ErrorsOf, to first order in eps; all is then
// enlarged by a quarter, which covers higher orders as long as the error of v' is at most v'/16.
//   in a plane  v' and u' are one fma each: relative error eps. tau_c, one division: 2 eps. tau1 = fma(c, tau_c, tau_c):
//               3 eps. u1 = fma(u', tau1, u0): eps |u1| + 4 eps |u'| tau1. f1 = -+(mu tau1): 4 eps.
//   in space    |u0| has 2 eps, wtn . u0 as a difference of products (core/numerics/products.h) 3 eps, its quotient
//               6 eps, so that v' is off by eps v' + 6 eps mu |wtn . e|, tau1 by (3 + 6 k) eps with
//               k = mu |wtn . e|/v'. u' likewise is off by eps |u'| + 6 eps mu |Wtt e|, component by component, so that
//               u1 is by eps |u1| + tau1 eps ((4 + 6 k) |u'| + 6 mu |Wtt e|). e has 3 eps, f1 (8 + 6 k) eps.
//   frictionless  u' and v' are exact: tau1 2 eps, u1 eps |u1| + 2 eps |Wtn| tau1.
//   all         v1: one product, eps |v1|.
// mu |wtn . e| = |v' - Wnn| and mu |Wtt e| = |u' - wtn| are taken from the slopes, exact to the order that counts.
// Every number that is not 0 has to lie between 2^-100 and 2^100, so that no product leaves the range of doubles
// (slopes are above 2^-360, works below 2^820); elsewhere the bound is infinite.
// Bad input: none gets here. The caller has made sure of v0 < 0, 0 <= c <= 1, with friction also of u0 != 0, mu > 0,
// v' > 0, and that slip does not stop nor turn by more than it allows (core/plan/).

#ifndef RICOCHET_CORE_MODELS_SLIDING_SLIDING_H_
#define RICOCHET_CORE_MODELS_SLIDING_SLIDING_H_

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/models/impact_end.h"
#include "core/models/relative_errors.h"
#include "core/numerics/products.h"
#include "ricochet/outcome.h"

namespace ricochet::sliding {

template <size_t kTangential>
using Vector = std::array<double, kTangential>;

template <size_t kTangential>
struct Problem {
  static_assert(kTangential == 1 || kTangential == 2);
  static constexpr size_t kDirections = kTangential + 1;  // The last is n.

  std::array<double, kDirections*(kDirections + 1) / 2> w = {};  // 1/kg, upper triangle row by row.
  Vector<kTangential> u0 = {};                                   // m/s
  double v0 = 0.0;                                               // m/s
  double mu = 0.0;
  double coefficient = 0.0;  // Newton's, Poisson's and energetic

  double Wnn() const { return w.back(); }
  // The trace of Wtt: not below any tangential mobility.
  double Wtt() const { return kTangential == 1 ? w[0] : w[0] + w[3]; }
  Vector<kTangential> Wtn() const {
    if constexpr (kTangential == 1) {
      return {w[1]};
    } else {
      return {w[2], w[4]};
    }
  }
};

// d(u, v, f)/dtau.
template <size_t kTangential>
struct Slopes {
  Vector<kTangential> u;
  double v;
  Vector<kTangential> f;
};

// What most columns of a sweep are made of.
template <size_t kTangential>
struct End {
  double tau_compression, tau1;
  Vector<kTangential> f1;
  Vector<kTangential> u1;
  double v1;
};

// Slip along u0.
template <size_t kTangential>
Slopes<kTangential> SlidingSlopes(const Problem<kTangential>& problem) {
  const auto& w = problem.w;
  const Vector<kTangential>& u0 = problem.u0;
  const double mu = problem.mu;
  if constexpr (kTangential == 1) {
    const double f = -std::copysign(mu, u0[0]);
    return {.u = {std::fma(f, w[0], w[1])}, .v = std::fma(f, w[1], w[2]), .f = {f}};
  } else {
    const double slip = std::sqrt(std::fma(u0[0], u0[0], u0[1] * u0[1]));
    const auto along = [&](double x, double y) { return DifferenceOfProducts(x, u0[0], -y, u0[1]) / slip; };
    return {.u = {std::fma(-mu, along(w[0], w[1]), w[2]), std::fma(-mu, along(w[1], w[3]), w[4])},
            .v = std::fma(-mu, along(w[2], w[4]), w[5]),
            .f = {-mu * (u0[0] / slip), -mu * (u0[1] / slip)}};
  }
}

namespace internal {

// All of an end but the friction impulse.
template <size_t kTangential>
End<kTangential> EndOfLine(const Problem<kTangential>& problem, const Vector<kTangential>& u_slope, double v_slope) {
  End<kTangential> end = {};
  end.tau_compression = -problem.v0 / v_slope;
  end.tau1 = std::fma(problem.coefficient, end.tau_compression, end.tau_compression);
  for (size_t i = 0; i < kTangential; ++i) end.u1[i] = std::fma(u_slope[i], end.tau1, problem.u0[i]) + 0.0;
  end.v1 = -problem.coefficient * problem.v0;
  return end;
}

inline bool Moderate(double value) {
  const double size = std::fabs(value);
  return size == 0.0 || (size >= 0x1p-100 && size <= 0x1p100);
}

template <size_t kTangential>
double Largest(const Vector<kTangential>& vector) {
  double largest = 0.0;
  for (const double value : vector) largest = std::max(largest, std::fabs(value));
  return largest;
}

}  // namespace internal

template <size_t kTangential>
End<kTangential> SolveEnd(const Problem<kTangential>& problem, const Slopes<kTangential>& slopes) {
  End<kTangential> end = internal::EndOfLine(problem, slopes.u, slopes.v);
  for (size_t i = 0; i < kTangential; ++i) end.f1[i] = slopes.f[i] * end.tau1;
  return end;
}

template <size_t kTangential>
End<kTangential> SolveEnd(const Problem<kTangential>& problem) {
  return SolveEnd(problem, SlidingSlopes(problem));
}

template <size_t kTangential>
End<kTangential> SolveFrictionlessEnd(const Problem<kTangential>& problem) {
  return internal::EndOfLine(problem, problem.Wtn(), problem.Wnn());
}

// Bounds on the errors of SolveEnd and Solve: see above.
template <size_t kTangential>
RelativeErrors ErrorsOf(const Problem<kTangential>& problem);

// The same of SolveFrictionlessEnd and SolveFrictionless.
template <size_t kTangential>
RelativeErrors FrictionlessErrorsOf(const Problem<kTangential>& problem);

template <size_t kTangential>
using Instant = ImpactInstant<Vector<kTangential>>;

// The sharp limit is never broken: c <= 1. That of energy is only where the caller excludes that slip stops: friction
// then drives it backwards, and may give more than restitution takes.
template <size_t kTangential>
struct Impact : ImpactEnd<Vector<kTangential>> {
  std::array<Instant<kTangential>, 3> events = {};  // The start, the ends of compression and of restitution.
  int event_count = 3;
};

template <size_t kTangential>
Impact<kTangential> Solve(const Problem<kTangential>& problem);

// Regime kFrictionless.
template <size_t kTangential>
Impact<kTangential> SolveFrictionless(const Problem<kTangential>& problem);

// The contact at normal impulse tau in [0, tau1] of either impact; kind is unspecified.
// Accuracy: 4 ulp of the largest value at the events.
template <size_t kTangential>
Instant<kTangential> At(const Impact<kTangential>& impact, double tau);

}  // namespace ricochet::sliding

#endif  // RICOCHET_CORE_MODELS_SLIDING_SLIDING_H_
