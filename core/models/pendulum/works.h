// The pendulum's works in proportion to each other, and the energy lost by the formula of Thomson and Tait.
//
// Accuracy: 1 ulp, but within 2^-100 of its scale where 1 - eta^2 changes sign (core/models/pendulum/pendulum.h).

#ifndef RICOCHET_CORE_MODELS_PENDULUM_WORKS_H_
#define RICOCHET_CORE_MODELS_PENDULUM_WORKS_H_

#include "core/models/pendulum/pendulum.h"

namespace ricochet::pendulum {

struct WorkRatios {
  double normal = 0.0;                // -Wr_n/Wc_n = eta^2 [40]
  double tangential = 0.0;            // Wr_t/Wc_t = eta^2, 0 where there is no friction [40]
  double total = 0.0;                 // -Wr/Wc = kappa_hat^2 = E+/E- [40]
  double tangential_to_normal = 0.0;  // W_t/W_n = x (1 + eta^2)/(1 - eta^2), infinite at eta = 1 [41]
  double compression_coupling = 0.0;  // Wc_t/Wc_n = x, also -Wr_t/Wr_n where there is restitution [42]
};

// The problem must not be separating.
WorkRatios SolveWorkRatios(const Problem& problem);

// dE = -f1 (u- + u+)/2 - tau1 (v- + v+)/2, the energy lost by an impact of any planar body [52]. Plain arithmetic: it
// checks an energy balance against impulses and velocities, and cancels where little is lost.
double ThomsonTaitLoss(double f1, double tau1, double u_minus, double u_plus, double v_minus, double v_plus);

}  // namespace ricochet::pendulum

#endif  // RICOCHET_CORE_MODELS_PENDULUM_WORKS_H_
