// Pendulum: the frictional impact of a rigid pendulum in closed form.
//
// Lubarda (2009), doi:10.1115/1.3172198. The pendulum has the moment of inertia J about the pin, its contact at (a,
// -b), the angular velocity omega- < 0 before the impact, kinetic friction mu and static friction mu_s. With q = mu
// |b|, x = q/a and r = (a - q)/(a + q):
//
//   tau0 = -J omega-/(a + q)                       impulse of compression                                [8]
//   kappa_hat = eta sqrt(r) = kappa r              Newton's, energetic, Poisson's coefficient            [15], [23-25]
//   omega+ = -kappa_hat omega-                     angular velocity after                                [11]
//   tau1 = (1 + kappa) tau0                        whole normal impulse                                  [10]
//   f1 = sgn(b) mu (1 - kappa) tau0                friction impulse                                      [48], [51]
//   mu_hat = f1/tau1                               Brach's coefficient                                   [49-51]
//   Wc_n = a tau0 omega-/2,  Wr_n = -eta^2 Wc_n    works of the normal impulse                           [22], [40]
//   Wc_t = q tau0 omega-/2,  Wr_t = eta^2 Wc_t     works of friction                                     [34], [40]
//   dE = J omega-^2 (1 - kappa_hat^2)/2            energy lost                                           [16], [52]
//
// The contact separates if omega- >= 0. It locks if mu_s |b| >= a: there is no restitution, all three coefficients are
// 0 and tau1 = tau0. It is frictionless if x = 0, and rebounds otherwise. Every threshold is decided exactly.
//
// Accuracy: each output is within 1 ulp of its exact value over the whole range of doubles; an output that changes its
// sign is right to 2^-100 of its scale. docs/theory/pendulum_numerics.md says more. The problem must be valid
// (core/scene/validate.h).

#ifndef RICOCHET_CORE_MODELS_PENDULUM_PENDULUM_H_
#define RICOCHET_CORE_MODELS_PENDULUM_PENDULUM_H_

#include <array>

#include "core/models/impact_errors.h"
#include "core/models/restitution_law.h"
#include "ricochet/outcome.h"
#include "ricochet/scene.h"

namespace ricochet::pendulum {

struct Problem {
  double inertia = 0.0;  // J
  double a = 0.0;
  double b = 0.0;
  double omega_minus = 0.0;  // omega-
  double mu = 0.0;
  double mu_static = 0.0;  // mu_s
  RestitutionLaw law = RestitutionLaw::kEnergetic;
  double coefficient = 0.0;  // kappa_hat, kappa or eta
};

// The outputs of a solution, in the order of Impact::values.
enum class Output {
  kNewton,
  kPoisson,
  kEnergetic,
  kTangentialCoefficient,  // mu_hat
  kOmegaPlus,
  kTangentialVelocityAfter,       // b omega+
  kNormalVelocityAfter,           // a omega+
  kNormalImpulseCompression,      // tau0
  kNormalImpulse,                 // tau1
  kTangentialImpulse,             // f1
  kTangentialImpulseCompression,  // sgn(b) mu tau0
  kWorkNormalCompression,
  kWorkNormalRestitution,
  kWorkTangentialCompression,
  kWorkTangentialRestitution,
  kWorkNormal,       // Wc_n + Wr_n = Wc_n (1 - eta^2), [36], [37]
  kWorkTangential,   // Wc_t + Wr_t = Wc_t (1 + eta^2), [35]
  kEnergyChange,     // -dE
  kEnergeticExcess,  // eta - 1 without cancellation; > 0 exactly if the sharp limit is broken
};

// Their paths in an outcome (ricochet/outcome_numbers.h); empty for those that are none of its numbers.
inline constexpr std::array kOutputPaths = {"coefficients.newton",
                                            "coefficients.poisson",
                                            "coefficients.energetic",
                                            "coefficients.tangential",
                                            "rates_after_rad_s[0]",
                                            "contact_velocity_after.tangential_m_s[0]",
                                            "contact_velocity_after.normal_m_s",
                                            "impulse.normal_compression_n_s",
                                            "impulse.normal_total_n_s",
                                            "impulse.tangential_n_s[0]",
                                            "",
                                            "work.normal_compression_j",
                                            "work.normal_restitution_j",
                                            "work.tangential_compression_j",
                                            "work.tangential_restitution_j",
                                            "work.normal_total_j",
                                            "work.tangential_total_j",
                                            "energy_change_j",
                                            ""};
inline constexpr int kOutputCount = kOutputPaths.size();

struct Impact {
  Regime regime = Regime::kUnspecified;
  bool sharp_limit_broken = false;   // eta > 1 [29]
  bool energy_limit_broken = false;  // kappa_hat > 1 [27]
  std::array<double, kOutputCount> values = {};

  double operator[](Output output) const { return values[static_cast<size_t>(output)]; }
};

// Computes all outputs of one impact in double-double arithmetic.
Impact Solve(const Problem& problem);

// An impact in plain double arithmetic, with a bound on its rounding error that costs two operations.
struct PlainImpact {
  Impact impact;
  // Bounds the error of each velocity over V = max(|u0|, |v0|); of each impulse times its mobility over V; of each work
  // and of the change of energy over the energy moved, (1 + eta^2) J omega-^2/2; of kappa_hat, kappa and eta over their
  // own value, and of mu_hat over mu, where values below 2^-700 count as 2^-700. docs/theory/rounding.md derives it.
  double relative_error = 0.0;
  // False if plain arithmetic cannot prove a regime, a broken limit or the bound; then the rest has no meaning.
  bool proved = false;
};

// Computes all outputs of one impact at a tenth of the cost of Solve. If proved, the regime and the broken limits are
// those of Solve. Not proved are only impacts within 2^-50 of a limit, with mu |b| = a or with a bound of 1 or more,
// and numbers beyond the range: J, a and |omega-| in [2^-100, 2^100], |b| and mu at most 2^100.
PlainImpact SolvePlain(const Problem& problem);

// The errors of all numbers, each on its own scale: of what Solve gives, and of what SolvePlain has proved.
// docs/theory/rounding.md derives them.
ImpactErrors ErrorsOf(const Problem& problem, const Impact& impact);
ImpactErrors PlainErrorsOf(const Problem& problem, const PlainImpact& plain);

// The state of the pendulum at normal impulse tau in [0, tau1]: Fig. 3 and Fig. 5 of the paper.
struct Instant {
  double omega = 0.0;               // omega(tau), [9]
  double tangential_impulse = 0.0;  // f(tau), [48]
};

// The problem must not separate. Accuracy: 1 ulp, or 2^-100 of |omega-| for omega and of mu tau0 for the impulse.
Instant At(const Problem& problem, double tau);

}  // namespace ricochet::pendulum

#endif  // RICOCHET_CORE_MODELS_PENDULUM_PENDULUM_H_
