#include "core/models/pendulum/works.h"

#include <cmath>
#include <limits>

#include "core/models/pendulum/wide.h"

namespace ricochet::pendulum {

WorkRatios SolveWorkRatios(const Problem& problem) {
  const WideSolution x = SolveAll(problem);
  const Wide one = Wide::Constant(1.0);
  const Wide coupling = x.q / x.a;
  const double eta_squared = Rounded(x.eta_squared);
  WorkRatios ratios = {.normal = eta_squared,
                       .tangential = Smooth(problem) ? 0.0 : eta_squared,
                       .total = Rounded(x.kappa_hat * x.kappa_hat),
                       .compression_coupling = Rounded(coupling)};
  const bool elastic = !IsPositive(x.one_minus_eta_squared) && !IsNegative(x.one_minus_eta_squared);
  if (Smooth(problem)) return ratios;
  ratios.tangential_to_normal = elastic ? std::numeric_limits<double>::infinity()
                                        : Rounded(coupling * (one + x.eta_squared) / x.one_minus_eta_squared);
  return ratios;
}

double ThomsonTaitLoss(double f1, double tau1, double u_minus, double u_plus, double v_minus, double v_plus) {
  return -0.5 * std::fma(f1, u_minus + u_plus, tau1 * (v_minus + v_plus));
}

}  // namespace ricochet::pendulum
