// Perturbed path: what a bound on the way of an impact is worth at its end.
//
// Scales: velocities by |v0|, mobilities by Wnn, normal impulses by |v0|/Wnn, so that v(0) = -1, v' = 1 + wtn f' and
// w = |Wtn|/Wnn, W = Wtt/Wnn. A and B are two impacts from the same start under the same law of restitution, tau the
// normal impulse, ' = d/dtau:
//
//   A  lo <= v_A' <= hi with lo > 0, |u_A'| <= U, |f_A'| <= F
//   B  |f_B - f_A|(tau) <= e_f(tau) = j + m (tau - from)+, of which the second part is by a slope of at most m,
//      |v_B - v_A| <= e_v = w e_f + q,   |u_B - u_A| <= e_u = W e_f + p
//      and, where it is known, bl <= v_B' <= bh with bl > 0
//
// Theorem. With L = min(lo, bl) and z = 0 where bl is known, else L = lo - w m and z = 2 (q + w j), and L > 0:
//
//   end of compression  |tau_cB - tau_cA| <= Dc = e_v(tau_cA)/L, tau_cA in [1/hi, 1/lo].
//       If B is first: lo (tau_cA - tau_cB) <= -v_A(tau_cB) <= e_v(tau_cB). If A is first: v_B(tau_cA) >= -e_v(tau_cA)
//       and grows by bl; or lo (tau_cB - tau_cA) <= v_A(tau_cB) <= e_v(tau_cB) <= e_v(tau_cA) + w m (tau_cB - tau_cA).
//   Newton     v1 is the same. As above from v = e in place of 0: |d tau1| <= e_v((1 + e)/lo)/L.
//   Poisson    |d tau1| <= (1 + k) Dc,   |d v1| <= e_v(tau1_B) + hi |d tau1|.
//   energetic  With E = the work that restitution has given back by then, integral of v: B stores at most
//       I = integral of e_v over [0, tau_cA + Dc] more or less than A, which stores at most 1/(2 lo).
//       v_B >= L y - z at tau_cB + y: eta^2 (1/(2 lo) + I) is given back by y = (z + sqrt(z^2 + 2 L eta^2 (...)))/L, which
//       bounds tau1_B <= last = 1/lo + Dc + y. On the way there A has given back what it does to its own end to
//       within d = eta^2 I + integral of e_v over [1/hi - Dc, last]. Since d(v_A^2)/dE is in [2 lo, 2 hi],
//       v_A(tau1_B)^2 and v1_A^2 differ by at most D = 2 hi d. If v1_A^2 >= r^2 = eta^2 lo/hi > D, then tau1_B lies in A's
//       restitution and |v_A(tau1_B) - v1_A| <= D/(r + sqrt(r^2 - D)); else that is at most sqrt(D) + hi Dc, the
//       second part for a tau1_B within A's compression. |d v1| <= that + e_v(last), |d tau1| <= that/lo.
//       eta = 0: both end where compression does, |d tau1| <= Dc.
//   by slopes alone, where bl and bh are known ([bl, bh] widened to contain [lo, hi]): work is v dv/v', so that
//       v1_B/eta is in [sqrt(bl/bh), sqrt(bh/bl)]; under Poisson's law v1_B/k in [bl/bh, bh/bl]; tau1 is in
//       [(1 + v1)/bh, (1 + v1)/bl], Poisson (1 + k) [1/bh, 1/bl]. The same of A. The smaller bound counts.
//   |d u1| <= e_u(tau1_B) + U |d tau1|,   Wtt |d f1| <= Wtt (e_f(tau1_B) + F |d tau1|).
//
// Rounding: lo and L have to be at least 2^-20, else the answer is infinite; inputs right to 2^-30 and the answer,
// enlarged by 2^-20 of itself, then bounds the true change. Differences that cancel have 2^-48 of their
// terms added. `from` has to be below its true value.

#ifndef RICOCHET_CORE_PLAN_PERTURBED_PATH_H_
#define RICOCHET_CORE_PLAN_PERTURBED_PATH_H_

#include <limits>

#include "core/models/pendulum/pendulum.h"
#include "core/models/restitution_law.h"

namespace ricochet {

inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();
inline constexpr double kLeastSlope = 0x1p-20;  // Of v, over Wnn.

struct Restoring {
  RestitutionLaw law = RestitutionLaw::kEnergetic;
  double coefficient = 0.0;
};

// Scaled mobilities: W and w.
struct Mobility {
  double tangential = 0.0;
  double coupling = 0.0;
};

struct ReferencePath {
  double slope_low = 1.0;  // lo
  double slope_high = 1.0;
  double u_slope = 0.0;  // U
  double f_slope = 0.0;  // F
};

struct Perturbation {
  double f_jump = 0.0;   // j
  double f_slope = 0.0;  // m
  double from = 0.0;
  double u = 0.0;           // p
  double v = 0.0;           // q
  double slope_low = 0.0;   // bl; 0 where it is not known.
  double slope_high = 0.0;  // bh
};

// The largest of |d u1|, |d v1|, |d tau1|, Wtt |d f1|, scaled; infinite where nothing is known.
double LargestChange(const Mobility& mobility, const Restoring& restoring, const ReferencePath& reference,
                     const Perturbation& perturbation);

// A bound that covers the rounding of what it was computed from and of itself; infinite for what is no number.
double Padded(double bound);

}  // namespace ricochet

#endif  // RICOCHET_CORE_PLAN_PERTURBED_PATH_H_
