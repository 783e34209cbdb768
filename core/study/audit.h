// Audit: what an observed impact implies, and which limits of an admissible impact it breaks.
//
// Given: the contact (W, the approach velocity v-, friction) and the velocity v+ after the impact that a simulator or
// an experiment has seen, each of its components within +-uncertainty. The contact is taken as stated.
//
// W of full rank. The impulse p = W^-1 (v+ - v-) is unique. Newton's coefficient is that of v+; Poisson's and the
// energetic one, the phases and the four works are those of the scene's Coulomb path run to the normal impulse p_n, and
// friction_mismatch is p_t - f(p_n), observed less path. energy_change = p . (v- + v+)/2 is that of the observation;
// residual, the sum of the works less it, is what the mismatch makes of it.
//
// W rank deficient. Many impulses lead to v+, or none. The audit is that of the point of the path at v+; if the path
// does not come there, `unexplained`, and the audit is that of the nearest point, `distance` (m/s) away.
//
// A contact that does not approach (regime separating) has no path but its start: unexplained unless v+ = v-.
//
// Limits and their allowances. A limit is broken if its excess is above its allowance: then no v+ within the
// uncertainty keeps it. With d_i >= |error of v+_i|, G = W^-1, and sums over i:
//
//   kNormalImpulse   p_n >= 0                sum |G_ni| d_i
//   kPenetration     v+_n >= 0               d_n
//   kCone            |p_t| <= mu p_n         sum |e . G_ti - mu G_ni| d_i,  e = p_t/|p_t|; convex, so its tangent bounds it.
//                                            mu is the static coefficient: a contact that sticks may use all of it.
//   kEnergy          E+ <= E-                sum |G v+|_i d_i;  E+ is convex in v+
//   kSharp           energetic <= 1          energetic(p_n) - energetic(p_n - kNormalImpulse's allowance), both on the
//                                            path; 0 where not exceeded. The coefficient rises with p_n: v > 0 there.
//
// Where W is rank deficient, p is on the path and keeps the first and the third; the others by moving v+ back along the
// path by d. Even exact data are doubles: d_i = uncertainty + 2^-46 (|v+_i| + |v-_i| + sum_j |W_ij p_j|), 64 ulp of the
// terms of W p = v+ - v-; energy is charged for that part with (|G (v- + v+)|_i + |p_i|)/2.
//
// Accuracy. G, p, the excess of the first four limits and the energy are computed with 100 bits and rounded once. The
// path is solved in doubles; the coefficients and works are then within the allowances of p_n, which grow like
// 1/det W: of tau_c, Poisson's coefficient has d (|Wtn| + Wtt)/(det W tau_c), det W = (1 - rho^2) Wtt Wnn.
//
// Bad input: none gets here but where a function says so; they assume a valid problem.

#ifndef RICOCHET_CORE_STUDY_AUDIT_H_
#define RICOCHET_CORE_STUDY_AUDIT_H_

#include <array>

#include "core/models/pendulum/pendulum.h"
#include "core/models/planar/planar.h"
#include "core/models/spatial/spatial.h"
#include "ricochet/audit.h"

namespace ricochet::audit {

struct PlanarObservation {
  double u1 = 0.0, v1 = 0.0;  // m/s
  double uncertainty = 0.0;   // m/s, >= 0
};

struct SpatialObservation {
  std::array<double, 2> u1 = {};
  double v1 = 0.0;
  double uncertainty = 0.0;
};

// The law and the coefficient of the problem are not used. In space the path is integrated to the problem's tolerance;
// a simulator's error belongs to the uncertainty. Where a spatial W is rank deficient the nearest point is searched
// for, in some hundred solutions.
AuditReport Audit(const planar::Problem& problem, const PlanarObservation& observation);
AuditReport Audit(const spatial::Problem& problem, const SpatialObservation& observation);

// The contact velocities (b w, a w) of a pendulum, as rank one in closed form.
AuditReport Audit(const pendulum::Problem& problem, const PlanarObservation& observation);
// The same from the angular velocity after the impact and its uncertainty in rad/s.
AuditReport AuditRate(const pendulum::Problem& problem, double omega_plus, double uncertainty);

// The path, in ricochet.v1.AuditResponse, of the first number that exceeds the largest double; null if none does. What
// an uncertainty can make of a number may be infinite.
const char* OverflowIn(const AuditReport& report);

}  // namespace ricochet::audit

#endif  // RICOCHET_CORE_STUDY_AUDIT_H_
