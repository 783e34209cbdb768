// Coulomb path: where the contact is once the normal impulse has reached tau, whatever ends the impact.
//
// Friction alone decides the path; a law of restitution only says where on it the impact ends (core/models/planar/planar.h,
// spatial.h). Poisson's law ends it at tau1 = (1 + k) tau_c, so k = tau/tau_c - 1 runs it to any tau >= tau_c. Before
// tau_c the planar path is straight between two events. The spatial one need not be, but slip depends on Wtt, wtn and
// u0 only: a contact with Wnn* = 2 (Wnn + mu |wtn|), for which dv*/dtau >= Wnn in slip and in stick, and with
// v0* = -Wnn tau/2 has come to its tau_c* by tau/2, and at tau
//
//   v = v* + (v0 - v0*) - (Wnn* - Wnn) tau,   integral of v = that of v* + (v0 - v0*) tau - (Wnn* - Wnn) tau^2/2

#ifndef RICOCHET_CORE_STUDY_COULOMB_PATH_H_
#define RICOCHET_CORE_STUDY_COULOMB_PATH_H_

#include <array>

#include "core/models/planar/planar.h"
#include "core/models/spatial/spatial.h"
#include "ricochet/outcome.h"

namespace ricochet::audit {

// A plane uses the first tangential direction only; the other is 0.
struct PathPoint {
  Regime regime = Regime::kUnspecified;  // What the contact has done so far.
  int w_rank = 0;
  double tau_compression = 0.0;  // Where compression ends, even if tau is less.
  double tau = 0.0;              // Less than asked for where the contact locks before: the path ends there.
  std::array<double, 2> f = {};
  std::array<double, 2> u = {};
  double v = 0.0;
  double newton = 0.0;            // -v/v0; negative before compression has ended, as Poisson's is.
  double poisson = 0.0;           // tau/tau_c - 1
  double energetic = 0.0;         // 0 before compression has ended.
  double energetic_excess = 0.0;  // energetic - 1
  double work_normal_compression = 0.0, work_normal_restitution = 0.0;
  double work_tangential_compression = 0.0, work_tangential_restitution = 0.0;
  double energy_change = 0.0;   // Since the start.
  double velocity_error = 0.0;  // m/s: what the path's velocities are held to.
};

// The law and the coefficient of the problem are not used. tau >= 0. A contact that does not approach has one point.
PathPoint PathAt(const planar::Problem& problem, double tau);
PathPoint PathAt(const spatial::Problem& problem, double tau);

// The point at which v first is `normal_m_s` >= 0. Where the contact locks, the end of the path.
PathPoint PathWhereNormalIs(const planar::Problem& problem, double normal_m_s);
PathPoint PathWhereNormalIs(const spatial::Problem& problem, double normal_m_s);

}  // namespace ricochet::audit

#endif  // RICOCHET_CORE_STUDY_COULOMB_PATH_H_
