// Coulomb path: the state of a contact once its normal impulse has reached tau, whatever ends the impact.
//
// Friction alone decides the path; a law of restitution only says where on it the impact ends
// (core/models/planar/planar.h, core/models/spatial/spatial.h). So the models give every point of it: Poisson's law
// ends an impact at tau = (1 + kappa) tau_c, which reaches any tau >= tau_c. Before tau_c the planar path is straight
// between two events, and the spatial one is that of another contact which ends its compression earlier
// (docs/theory/audit.md). Accuracy: that of the models; velocity_error says it.

#ifndef RICOCHET_CORE_AUDIT_COULOMB_PATH_H_
#define RICOCHET_CORE_AUDIT_COULOMB_PATH_H_

#include <array>
#include <cstdint>

#include "core/models/planar/planar.h"
#include "core/models/spatial/spatial.h"
#include "ricochet/outcome.h"

namespace ricochet::audit {

// A plane uses the first tangential direction only; the other is 0. Impulses in N s, velocities in m/s, works in J.
struct PathPoint {
  // The regime of the path up to this point; kUnspecified if the model's steps did not lead to it.
  Regime regime = Regime::kUnspecified;
  int w_rank = 0;
  double tau_compression = 0.0;  // The end of compression, even if tau is less.
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
  double velocity_error = 0.0;  // Bound on the error of u and v.
  int64_t steps = 0;            // The steps of all impacts that were solved for it.
};

// Gives the point at tau >= 0. A contact that does not approach has one point. The law and the coefficient of the
// problem are not used.
PathPoint PathAt(const planar::Problem& problem, double tau);
PathPoint PathAt(const spatial::Problem& problem, double tau);

// Gives the point at which v first is `normal_m_s` >= 0. Where the contact locks it is the end of the path.
PathPoint PathWhereNormalIs(const planar::Problem& problem, double normal_m_s);
PathPoint PathWhereNormalIs(const spatial::Problem& problem, double normal_m_s);

}  // namespace ricochet::audit

#endif  // RICOCHET_CORE_AUDIT_COULOMB_PATH_H_
