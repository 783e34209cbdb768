// Pendulum: the frictional impact of a rigid pendulum in closed form.
//
// Lubarda (2009), doi:10.1115/1.3172198. Inertia J about the pin, contact at (a, -b), angular velocity w- < 0 before,
// kinetic friction mu, static friction mu_s. With q = mu |b|, x = q/a and r = (a - q)/(a + q):
//
//   tau0 = -J w-/(a + q)                           impulse of compression                                  [8]
//   kappa_hat = eta sqrt(r) = kappa r              Newton's, energetic, Poisson's coefficient              [15], [23-25]
//   w+ = -kappa_hat w-                             angular velocity after                                  [11]
//   tau1 = (1 + kappa) tau0                        whole normal impulse                                    [10]
//   f1 = sgn(b) mu (1 - kappa) tau0                friction impulse                                        [48], [51]
//   mu_hat = f1/tau1                               Brach's coefficient                                     [49-51]
//   Wc_n = a tau0 w-/2,  Wr_n = -eta^2 Wc_n        works of the normal impulse                             [22], [40]
//   Wc_t = q tau0 w-/2,  Wr_t = eta^2 Wc_t         works of friction                                       [34], [40]
//   dE = J w-^2 (1 - kappa_hat^2)/2                energy lost                                             [16], [52]
//
// Regimes: separating if w- >= 0; locked if mu_s |b| >= a (no restitution: all three coefficients 0, tau1 = tau0);
// frictionless if x = 0; rebound otherwise. Every threshold of a regime is decided exactly.
//
// Accuracy: each output within 1 ulp of the exact value of the exact inputs over the whole double range. Where an
// output changes sign (1 - eta^2, 1 - kappa, 1 - kappa_hat^2 under another law's coefficient), to 2^-100 of its scale.
// Below 2^-1022: within 1 unit of 2^-1074. An exact value above the largest double comes out infinite.
// A limit that is broken or kept by more than 2^-100 of the terms compared is reported so; closer than that, either
// way.
// Bad input: none gets here (core/scene/validate.h); the functions assume a valid problem.

#ifndef RICOCHET_CORE_MODELS_PENDULUM_PENDULUM_H_
#define RICOCHET_CORE_MODELS_PENDULUM_PENDULUM_H_

#include <array>
#include <cstdint>

#include "absl/types/span.h"
#include "core/models/restitution_law.h"
#include "ricochet/outcome.h"
#include "ricochet/scene.h"

namespace ricochet::pendulum {

struct Problem {
  double inertia = 0.0;  // J
  double a = 0.0;
  double b = 0.0;
  double omega_minus = 0.0;  // w-
  double mu = 0.0;
  double mu_static = 0.0;  // mu_s
  RestitutionLaw law = RestitutionLaw::kEnergetic;
  double coefficient = 0.0;  // kappa_hat, kappa or eta
};

// What a solve can give. The order is that of Impact's values.
enum class Output {
  kNewton,
  kPoisson,
  kEnergetic,
  kTangentialCoefficient,  // mu_hat
  kOmegaPlus,
  kTangentialVelocityAfter,       // b w+
  kNormalVelocityAfter,           // a w+
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
  kEnergeticExcess,  // eta - 1, free of cancellation; > 0 exactly if the sharp limit is broken
};
inline constexpr int kOutputCount = 19;

struct Impact {
  Regime regime = Regime::kUnspecified;
  bool sharp_limit_broken = false;   // eta > 1 [29]
  bool energy_limit_broken = false;  // kappa_hat > 1 [27]
  std::array<double, kOutputCount> values = {};

  double operator[](Output output) const { return values[static_cast<size_t>(output)]; }
};

// Everything about one impact.
Impact Solve(const Problem& problem);

// Many impacts, only the outputs asked for, with the bits that Solve gives. `columns[c][i]` receives output
// `outputs[c]` of `problems[i]`; `regimes` and `inadmissible` have one entry a problem.
void SolveColumns(absl::Span<const Problem> problems, absl::Span<const Output> outputs,
                  absl::Span<double* const> columns, absl::Span<Regime> regimes, absl::Span<bool> inadmissible);

// The contact at normal impulse tau in [0, tau1] of an impact: Fig. 3 and Fig. 5 of the paper.
struct Instant {
  double omega = 0.0;               // w(tau), [9]
  double tangential_impulse = 0.0;  // f(tau), [48]
};

// Accuracy: 1 ulp or 2^-100 of |w-| (omega) or of mu tau0 (impulse). The problem must not be separating.
Instant At(const Problem& problem, double tau);

}  // namespace ricochet::pendulum

#endif  // RICOCHET_CORE_MODELS_PENDULUM_PENDULUM_H_
