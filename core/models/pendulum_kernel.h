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
  kPartWork = 1U << 7,
  kPartAll = (1U << 8) - 1,
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
      return kPartTau0;
    case Output::kWorkNormalCompression:
    case Output::kWorkTangentialCompression:
    case Output::kWorkNormal:
      return kPartTau0 | kPartWork;
    case Output::kWorkNormalRestitution:
    case Output::kWorkTangentialRestitution:
    case Output::kWorkTangential:
      return kPartTau0 | kPartWork | kPartEtaSquared;
    case Output::kEnergyChange:
      return kPartEnergyLoss;
  }
  return 0;
}

// What is solved once a problem; the outputs are products of these.
template <typename N>
struct Solution {
  Regime regime = Regime::kUnspecified;
  bool energy_limit_broken = false;
  N inertia, a, b, mu, omega;  // mu carries the sign of b; omega is w-
  N q, s, d;                   // mu |b|, a + q, a - q
  N inverse_s, inverse_d;      // inverse_d is not set where locked
  N kappa, kappa_hat, eta, eta_squared;
  N one_minus_kappa, inverse_one_plus_kappa, one_minus_eta_squared;
  N energy_loss;  // 1 - kappa_hat^2
  N tau0;
  N half_omega_tau0;
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

// 1/(1 + kappa), which both outputs of 1 - kappa use.
template <typename N>
RICOCHET_INLINE void SolveInverse(unsigned parts, Solution<N>& x) {
  if (parts & kPartOneMinusKappa) x.inverse_one_plus_kappa = Inverse(N(1.0) + x.kappa);
}

template <typename N>
RICOCHET_INLINE void SolveEnergetic(double coefficient, unsigned parts, Solution<N>& x) {
  const N one(1.0);
  const N eta(coefficient);
  x.eta = eta;
  x.eta_squared = SquareOf(eta);
  x.one_minus_eta_squared = (one - eta) * (one + eta);
  if (parts & (kPartKappa | kPartKappaHat)) {
    const N scaled_root = eta * Sqrt(x.s * x.d);
    x.kappa = scaled_root * x.inverse_d;
    x.kappa_hat = scaled_root * x.inverse_s;
  }
  SolveInverse(parts, x);
  if (parts & kPartOneMinusKappa) {
    x.one_minus_kappa =
        Numerator(x, Lead::kD, coefficient, Power::kTwo, coefficient <= 0.5) * x.inverse_d * x.inverse_one_plus_kappa;
  }
  if (parts & kPartEnergyLoss) {
    x.energy_loss = Numerator(x, Lead::kS, coefficient, Power::kTwo, false) * x.inverse_s;
  }
}

template <typename N>
RICOCHET_INLINE void SolveNewton(double coefficient, unsigned parts, Solution<N>& x) {
  const N one(1.0);
  const N e(coefficient);
  const bool first_form = coefficient <= 0.5;
  x.kappa_hat = e;
  x.one_minus_eta_squared = Numerator(x, Lead::kD, coefficient, Power::kTwo, first_form) * x.inverse_d;
  x.energy_limit_broken = coefficient > 1.0;
  if (parts & (kPartKappa | kPartEtaSquared)) x.kappa = e * x.s * x.inverse_d;
  SolveInverse(parts, x);
  if (parts & kPartOneMinusKappa) {
    x.one_minus_kappa = Numerator(x, Lead::kD, coefficient, Power::kOne, first_form) * x.inverse_d;
  }
  if (parts & kPartEta) x.eta = e * Sqrt(x.s * x.d) * x.inverse_d;
  if (parts & kPartEtaSquared) x.eta_squared = e * x.kappa;
  if (parts & kPartEnergyLoss) x.energy_loss = (one - e) * (one + e);
}

template <typename N>
RICOCHET_INLINE void SolvePoisson(double coefficient, unsigned parts, Solution<N>& x) {
  const N one(1.0);
  const N k(coefficient);
  const bool first_form = coefficient >= 2.0;
  const N one_minus_kappa_hat = Numerator(x, Lead::kS, coefficient, Power::kOne, first_form) * x.inverse_s;
  x.kappa = k;
  x.one_minus_kappa = one - k;
  x.one_minus_eta_squared = Numerator(x, Lead::kS, coefficient, Power::kTwo, first_form) * x.inverse_s;
  x.energy_limit_broken = Sign(one_minus_kappa_hat) < 0;
  SolveInverse(parts, x);
  if (parts & (kPartKappaHat | kPartEnergyLoss | kPartEtaSquared)) x.kappa_hat = k * x.d * x.inverse_s;
  if (parts & kPartEta) x.eta = k * Sqrt(x.s * x.d) * x.inverse_s;
  if (parts & kPartEtaSquared) x.eta_squared = k * x.kappa_hat;
  if (parts & kPartEnergyLoss) x.energy_loss = one_minus_kappa_hat * (one + x.kappa_hat);
}

// Locked: no restitution, whatever the law and the coefficient.
template <typename N>
RICOCHET_INLINE void SolveLocked(Solution<N>& x) {
  const N zero;
  const N one(1.0);
  x.kappa = x.kappa_hat = x.eta = x.eta_squared = zero;
  x.one_minus_kappa = x.inverse_one_plus_kappa = x.one_minus_eta_squared = x.energy_loss = one;
}

// Geometry and regime. The problem must not be separating.
template <typename N>
RICOCHET_INLINE void SolveGeometry(const Problem& problem, Solution<N>& x) {
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
}

// Everything behind `parts`. `x` may hold the solution of another problem.
template <typename N>
RICOCHET_INLINE void SolveParts(const Problem& problem, unsigned parts, Solution<N>& x) {
  SolveGeometry(problem, x);
  x.inverse_s = Inverse(x.s);
  if (parts & kPartTau0) x.tau0 = x.inertia * -x.omega * x.inverse_s;
  if (parts & kPartWork) x.half_omega_tau0 = N(0.5) * x.omega * x.tau0;
  x.energy_limit_broken = false;
  if (x.regime == Regime::kLocked) {
    SolveLocked(x);
    return;
  }
  x.inverse_d = Inverse(x.d);
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
}

// One output, rounded; its parts must have been solved.
template <typename N>
RICOCHET_INLINE double Evaluate(const Solution<N>& x, Output output) {
  const N one(1.0);
  switch (output) {
    case Output::kNewton:
      return ToDouble(x.kappa_hat);
    case Output::kPoisson:
      return ToDouble(x.kappa);
    case Output::kEnergetic:
      return ToDouble(x.eta);
    case Output::kTangentialCoefficient:
      return RoundedProduct(x.mu * x.one_minus_kappa, x.inverse_one_plus_kappa);
    case Output::kOmegaPlus:
      return RoundedProduct(-x.kappa_hat, x.omega);
    case Output::kTangentialVelocityAfter:
      return RoundedProduct(-x.kappa_hat * x.omega, x.b);
    case Output::kNormalVelocityAfter:
      return RoundedProduct(-x.kappa_hat * x.omega, x.a);
    case Output::kNormalImpulseCompression:
      return ToDouble(x.tau0);
    case Output::kNormalImpulse:
      return RoundedProduct(one + x.kappa, x.tau0);
    case Output::kTangentialImpulse:
      return RoundedProduct(x.mu * x.one_minus_kappa, x.tau0);
    case Output::kTangentialImpulseCompression:
      return RoundedProduct(x.mu, x.tau0);
    case Output::kWorkNormalCompression:
      return RoundedProduct(x.a, x.half_omega_tau0);
    case Output::kWorkNormalRestitution:
      return RoundedProduct(-x.a * x.half_omega_tau0, x.eta_squared);
    case Output::kWorkTangentialCompression:
      return RoundedProduct(x.q, x.half_omega_tau0);
    case Output::kWorkTangentialRestitution:
      return RoundedProduct(x.q * x.half_omega_tau0, x.eta_squared);
    case Output::kWorkNormal:
      return RoundedProduct(x.a * x.half_omega_tau0, x.one_minus_eta_squared);
    case Output::kWorkTangential:
      return RoundedProduct(x.q * x.half_omega_tau0, one + x.eta_squared);
    case Output::kEnergyChange:
      return RoundedProduct(N(-0.5) * x.inertia * x.omega * x.omega, x.energy_loss);
    case Output::kEnergeticExcess:
      return ToDouble(-x.one_minus_eta_squared / (one + x.eta));
  }
  return 0.0;
}

}  // namespace ricochet::pendulum

#endif  // RICOCHET_CORE_MODELS_PENDULUM_KERNEL_H_
