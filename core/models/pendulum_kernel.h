// The pendulum's formulas (core/models/pendulum.h) over a number type N: DoubleDouble for moderate inputs, Wide for all.
//
// Nothing cancels. With s = a + q and d = a - q (q = mu |b| exact), the differences that could are written as
//   energetic eta:   1 - kappa = n/(d (1 + kappa)),  n = d - eta^2 s = a (1-eta)(1+eta) - q (1 + eta^2)
//                    1 - kappa_hat^2 = (a (1-eta)(1+eta) + q (1 + eta^2))/s
//   Newton e:        1 - kappa = (d - e s)/d = (a (1-e) - q (1+e))/d
//                    1 - eta^2 = (d - e^2 s)/d = (a (1-e)(1+e) - q (1 + e^2))/d
//   Poisson k:       1 - kappa_hat = (s - k d)/s = (a (1-k) + q (1+k))/s
//                    1 - eta^2 = (s - k^2 d)/s = (a (1-k)(1+k) + q (1 + k^2))/s
// Each numerator has two forms: the first keeps its accuracy where d is small against a, the second where the
// coefficient is near 1 and q small against a. The rounding left is at most 25 u^2 of the larger term.

#ifndef RICOCHET_CORE_MODELS_PENDULUM_KERNEL_H_
#define RICOCHET_CORE_MODELS_PENDULUM_KERNEL_H_

#include <cmath>

#include "core/models/pendulum.h"
#include "core/numerics/double_double.h"

namespace ricochet::pendulum {

// Intermediate results that outputs share; only those that an output needs are computed.
enum Part : unsigned {
  kPartKappa = 1U << 0,
  kPartKappaHat = 1U << 1,
  kPartOneMinusKappa = 1U << 2,
  kPartEta = 1U << 3,
  kPartEtaSquared = 1U << 4,
  kPartEnergyLoss = 1U << 5,
  kPartTau0 = 1U << 6,
};

// The parts behind an output.
inline unsigned PartsOf(Output output) {
  switch (output) {
    case Output::kNewton:
    case Output::kOmegaPlus:
    case Output::kTangentialVelocityAfter:
    case Output::kNormalVelocityAfter:
      return kPartKappaHat;
    case Output::kPoisson:
      return kPartKappa;
    case Output::kEnergetic:
    case Output::kEnergeticExcess:
      return kPartEta;
    case Output::kTangentialCoefficient:
      return kPartKappa | kPartOneMinusKappa;
    case Output::kNormalImpulse:
      return kPartKappa | kPartTau0;
    case Output::kTangentialImpulse:
      return kPartKappa | kPartOneMinusKappa | kPartTau0;
    case Output::kNormalImpulseCompression:
    case Output::kTangentialImpulseCompression:
    case Output::kWorkNormalCompression:
    case Output::kWorkTangentialCompression:
    case Output::kWorkNormal:
      return kPartTau0;
    case Output::kWorkNormalRestitution:
    case Output::kWorkTangentialRestitution:
    case Output::kWorkTangential:
      return kPartTau0 | kPartEtaSquared;
    case Output::kEnergyChange:
      return kPartEnergyLoss;
  }
  return 0;
}

// What is solved once a problem; the outputs are products of these.
template <typename N>
struct Solution {
  Regime regime = Regime::kUnspecified;
  N inertia, a, b, mu, omega;  // mu carries the sign of b; omega is w-
  N q, s, d;                   // mu |b|, a + q, a - q
  N kappa, kappa_hat, eta, eta_squared;
  N one_minus_kappa, one_minus_eta_squared;
  N energy_loss;  // 1 - kappa_hat^2
  N tau0;
  bool energy_limit_broken = false;
};

template <typename N>
RICOCHET_INLINE N SquareOf(const N& x) {
  return x * x;
}

// A numerator of the table above: lead - c trail with c = coefficient or its square, lead and trail being d and s or s
// and d. The second form is a (1 - c) -+ q (1 + c), - where d leads.
enum class Power { kOne, kTwo };
enum class Lead { kD, kS };

template <typename N>
RICOCHET_INLINE N Numerator(const Solution<N>& x, Lead lead, double coefficient, Power power, bool first_form) {
  const N one(1.0);
  const N given(coefficient);
  const N c = power == Power::kTwo ? SquareOf(given) : given;
  if (first_form) return lead == Lead::kD ? x.d - c * x.s : x.s - c * x.d;
  N complement = one - given;
  if (power == Power::kTwo) complement = complement * (one + given);
  const N friction = x.q * (one + c);
  return lead == Lead::kD ? x.a * complement - friction : x.a * complement + friction;
}

template <typename N>
RICOCHET_INLINE void SolveEnergetic(double coefficient, unsigned parts, Solution<N>& x) {
  const N one(1.0);
  const N eta(coefficient);
  x.eta = eta;
  x.eta_squared = SquareOf(eta);
  x.one_minus_eta_squared = (one - eta) * (one + eta);
  if (parts & (kPartKappa | kPartOneMinusKappa)) x.kappa = eta * Sqrt(x.s / x.d);
  if (parts & kPartKappaHat) x.kappa_hat = eta * Sqrt(x.d / x.s);
  if (parts & kPartOneMinusKappa) {
    x.one_minus_kappa = Numerator(x, Lead::kD, coefficient, Power::kTwo, coefficient <= 0.5) / (x.d * (one + x.kappa));
  }
  if (parts & kPartEnergyLoss) x.energy_loss = Numerator(x, Lead::kS, coefficient, Power::kTwo, false) / x.s;
}

template <typename N>
RICOCHET_INLINE void SolveNewton(double coefficient, unsigned parts, Solution<N>& x) {
  const N one(1.0);
  const N e(coefficient);
  const bool first_form = coefficient <= 0.5;
  x.kappa_hat = e;
  x.one_minus_eta_squared = Numerator(x, Lead::kD, coefficient, Power::kTwo, first_form) / x.d;
  x.energy_limit_broken = coefficient > 1.0;
  if (parts & kPartKappa) x.kappa = e * x.s / x.d;
  if (parts & kPartOneMinusKappa)
    x.one_minus_kappa = Numerator(x, Lead::kD, coefficient, Power::kOne, first_form) / x.d;
  if (parts & kPartEta) x.eta = e * Sqrt(x.s / x.d);
  if (parts & kPartEtaSquared) x.eta_squared = SquareOf(e) * x.s / x.d;
  if (parts & kPartEnergyLoss) x.energy_loss = (one - e) * (one + e);
}

template <typename N>
RICOCHET_INLINE void SolvePoisson(double coefficient, unsigned parts, Solution<N>& x) {
  const N one(1.0);
  const N k(coefficient);
  const bool first_form = coefficient >= 2.0;
  const N kappa_hat_complement = Numerator(x, Lead::kS, coefficient, Power::kOne, first_form) / x.s;
  x.kappa = k;
  x.one_minus_kappa = one - k;
  x.one_minus_eta_squared = Numerator(x, Lead::kS, coefficient, Power::kTwo, first_form) / x.s;
  x.energy_limit_broken = Sign(kappa_hat_complement) < 0;
  if (parts & (kPartKappaHat | kPartEnergyLoss)) x.kappa_hat = k * x.d / x.s;
  if (parts & kPartEta) x.eta = k * Sqrt(x.d / x.s);
  if (parts & kPartEtaSquared) x.eta_squared = SquareOf(k) * x.d / x.s;
  if (parts & kPartEnergyLoss) x.energy_loss = kappa_hat_complement * (one + x.kappa_hat);
}

// Locked: no restitution, whatever the law and the coefficient.
template <typename N>
RICOCHET_INLINE void SolveLocked(Solution<N>& x) {
  const N one(1.0);
  x.one_minus_kappa = one;
  x.one_minus_eta_squared = one;
  x.energy_loss = one;
}

// Geometry and regime. The problem must not be separating.
template <typename N>
RICOCHET_INLINE Solution<N> SolveGeometry(const Problem& problem) {
  Solution<N> x;
  const bool smooth = problem.mu == 0.0 || problem.b == 0.0;
  x.inertia = N(problem.inertia);
  x.a = N(problem.a);
  x.b = N(problem.b);
  x.omega = N(problem.omega_minus);
  x.mu = N(smooth ? 0.0 : std::copysign(problem.mu, problem.b));
  x.q = x.mu * x.b;
  x.s = x.a + x.q;
  x.d = x.a - x.q;
  const bool same = problem.mu_static == problem.mu;
  const N static_margin = same ? x.d : x.a - N(problem.mu_static) * N(std::fabs(problem.b));
  if (Sign(static_margin) <= 0) {
    x.regime = Regime::kLocked;
  } else {
    x.regime = smooth ? Regime::kFrictionless : Regime::kRebound;
  }
  return x;
}

template <typename N>
RICOCHET_INLINE Solution<N> SolveParts(const Problem& problem, unsigned parts) {
  Solution<N> x = SolveGeometry<N>(problem);
  if (parts & kPartTau0) x.tau0 = x.inertia * -x.omega / x.s;
  if (x.regime == Regime::kLocked) {
    SolveLocked(x);
    return x;
  }
  switch (problem.law) {
    case Law::kNewton:
      SolveNewton(problem.coefficient, parts, x);
      break;
    case Law::kPoisson:
      SolvePoisson(problem.coefficient, parts, x);
      break;
    case Law::kEnergetic:
      SolveEnergetic(problem.coefficient, parts, x);
      break;
  }
  return x;
}

// One output; its parts must have been solved.
template <typename N>
RICOCHET_INLINE N Evaluate(const Solution<N>& x, Output output) {
  const N one(1.0);
  const N half(0.5);
  switch (output) {
    case Output::kNewton:
      return x.kappa_hat;
    case Output::kPoisson:
      return x.kappa;
    case Output::kEnergetic:
      return x.eta;
    case Output::kTangentialCoefficient:
      return x.mu * x.one_minus_kappa / (one + x.kappa);
    case Output::kOmegaPlus:
      return -x.kappa_hat * x.omega;
    case Output::kTangentialVelocityAfter:
      return -x.kappa_hat * x.omega * x.b;
    case Output::kNormalVelocityAfter:
      return -x.kappa_hat * x.omega * x.a;
    case Output::kNormalImpulseCompression:
      return x.tau0;
    case Output::kNormalImpulse:
      return (one + x.kappa) * x.tau0;
    case Output::kTangentialImpulse:
      return x.mu * x.one_minus_kappa * x.tau0;
    case Output::kTangentialImpulseCompression:
      return x.mu * x.tau0;
    case Output::kWorkNormalCompression:
      return half * x.a * x.tau0 * x.omega;
    case Output::kWorkNormalRestitution:
      return -(half * x.a * x.tau0 * x.omega * x.eta_squared);
    case Output::kWorkTangentialCompression:
      return half * x.q * x.tau0 * x.omega;
    case Output::kWorkTangentialRestitution:
      return half * x.q * x.tau0 * x.omega * x.eta_squared;
    case Output::kWorkNormal:
      return half * x.a * x.tau0 * x.omega * x.one_minus_eta_squared;
    case Output::kWorkTangential:
      return half * x.q * x.tau0 * x.omega * (one + x.eta_squared);
    case Output::kEnergyChange:
      return -(half * x.inertia * x.omega * x.omega * x.energy_loss);
    case Output::kEnergeticExcess:
      return -x.one_minus_eta_squared / (one + x.eta);
  }
  return N();
}

}  // namespace ricochet::pendulum

#endif  // RICOCHET_CORE_MODELS_PENDULUM_KERNEL_H_
