// The pendulum's formulas (core/models/pendulum/pendulum.h) over a number type N: DoubleDouble for moderate inputs,
// Wide for all, and Plain, whose errors core/models/pendulum/rounding-inl.h bounds.
//
// In the wider types no difference cancels. With s = a + q and d = a - q (q = mu |b| is exact), a difference such as
// 1 - kappa is a numerator divided by s or d, and each numerator has two forms: d - c s keeps its accuracy if d is
// small compared with a, and a (1 - c) - q (1 + c) if c is near 1 and q is small compared with a. The rounding error
// left is at most 25 u^2 of the larger term. Plain arithmetic takes the first form, because its bound does not gain by
// the second. docs/theory/pendulum_numerics.md lists all numerators.

// Per-target include guard.
#if defined(RICOCHET_CORE_MODELS_PENDULUM_KERNEL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef RICOCHET_CORE_MODELS_PENDULUM_KERNEL_INL_H_
#undef RICOCHET_CORE_MODELS_PENDULUM_KERNEL_INL_H_
#else
#define RICOCHET_CORE_MODELS_PENDULUM_KERNEL_INL_H_
#endif

#include "core/models/pendulum/parts.h"
#include "core/models/pendulum/pendulum.h"
#include "core/models/restitution_law.h"
#include "core/numerics/double_double-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ricochet::pendulum::HWY_NAMESPACE {

using ricochet::HWY_NAMESPACE::InNoLane;
using ricochet::HWY_NAMESPACE::Not;

// The inputs of problems of one law, one problem in each lane.
template <typename N, typename Mask>
struct Inputs {
  N inertia, a, b, omega;  // omega is omega-
  N mu;                    // mu with the sign of b; 0 if b = 0.
  N mu_static;             // mu_s with the sign of b
  N coefficient;
  Mask near_one;  // Unless N is Plain, selects the second form of a numerator: coefficient > 1/2, Poisson's < 2.
};

// The quantities that are computed once for a problem; the outputs are products of these.
template <typename N, typename Mask>
struct Solution {
  N inertia, a, b, mu, omega;
  N q, s, d;  // mu |b|, a + q, a - q
  N margin;   // a - mu_s |b|
  Mask locked;
  N inverse_s, inverse_d;  // inverse_d has no meaning if locked
  N kappa, kappa_hat, eta, eta_squared;
  N one_minus_kappa, inverse_one_plus_kappa, one_minus_eta_squared;
  N one_minus_kappa_hat, energy_loss;  // energy_loss is 1 - kappa_hat^2
  N tau0;
  N half_omega_tau0;
};

template <typename N>
HWY_INLINE N SquareOf(const N& x) {
  return x * x;
}

// A numerator is lead - c trail, where c is the coefficient or its square, and lead and trail are d and s or s and d.
// The second form is a (1 - c) - q (1 + c) if d leads, and a (1 - c) + q (1 + c) if s leads.
enum class Power { kOne, kTwo };
enum class Lead { kD, kS };

template <Lead kLead, Power kPower, typename N, typename Mask>
HWY_INLINE N NearOneNumerator(const Inputs<N, Mask>& in, const Solution<N, Mask>& x) {
  const N one = N::Constant(1.0);
  const N& given = in.coefficient;
  const N c = kPower == Power::kTwo ? SquareOf(given) : given;
  const N complement = kPower == Power::kTwo ? (one - given) * (one + given) : one - given;
  const N friction = x.q * (one + c);
  return kLead == Lead::kD ? x.a * complement - friction : x.a * complement + friction;
}

template <Lead kLead, Power kPower, typename N, typename Mask>
HWY_INLINE N Numerator(const Inputs<N, Mask>& in, const Solution<N, Mask>& x) {
  const N c = kPower == Power::kTwo ? SquareOf(in.coefficient) : in.coefficient;
  const N direct = kLead == Lead::kD ? SubtractProduct(x.d, c, x.s) : SubtractProduct(x.s, c, x.d);
  if constexpr (!N::kCompensated) return direct;
  return Select(in.near_one, NearOneNumerator<kLead, kPower>(in, x), direct);
}

// Computes 1/(1 + kappa), which both outputs of 1 - kappa use.
template <typename N, typename Mask>
HWY_INLINE void SolveInverse(unsigned parts, Solution<N, Mask>& x) {
  if (parts & kPartOneMinusKappa) x.inverse_one_plus_kappa = Inverse(N::Constant(1.0) + x.kappa);
}

template <typename N, typename Mask>
HWY_INLINE void SolveEnergetic(const Inputs<N, Mask>& in, unsigned parts, Solution<N, Mask>& x) {
  const N one = N::Constant(1.0);
  const N& eta = in.coefficient;
  x.eta = eta;
  x.eta_squared = SquareOf(eta);
  x.one_minus_eta_squared = (one - eta) * (one + eta);
  x.one_minus_kappa_hat = one;  // Only its sign is used, and kappa_hat <= sqrt(r) <= 1.
  if (parts & (kPartKappa | kPartKappaHat)) {
    const N scaled_root = eta * Sqrt(x.s * x.d);
    x.kappa = scaled_root * x.inverse_d;
    x.kappa_hat = scaled_root * x.inverse_s;
  }
  SolveInverse(parts, x);
  if (parts & kPartOneMinusKappa) {
    x.one_minus_kappa = Numerator<Lead::kD, Power::kTwo>(in, x) * x.inverse_d * x.inverse_one_plus_kappa;
  }
  if (parts & kPartEnergyLoss) {
    x.energy_loss = NearOneNumerator<Lead::kS, Power::kTwo>(in, x) * x.inverse_s;
  }
}

template <typename N, typename Mask>
HWY_INLINE void SolveNewton(const Inputs<N, Mask>& in, unsigned parts, Solution<N, Mask>& x) {
  const N one = N::Constant(1.0);
  const N& e = in.coefficient;
  x.kappa_hat = e;
  x.one_minus_kappa_hat = one - e;
  x.one_minus_eta_squared = Numerator<Lead::kD, Power::kTwo>(in, x) * x.inverse_d;
  if (parts & (kPartKappa | kPartEtaSquared)) x.kappa = e * x.s * x.inverse_d;
  SolveInverse(parts, x);
  if (parts & kPartOneMinusKappa) x.one_minus_kappa = Numerator<Lead::kD, Power::kOne>(in, x) * x.inverse_d;
  if (parts & kPartEta) x.eta = e * Sqrt(x.s * x.d) * x.inverse_d;
  if (parts & kPartEtaSquared) x.eta_squared = e * x.kappa;
  if (parts & kPartEnergyLoss) x.energy_loss = x.one_minus_kappa_hat * (one + e);
}

template <typename N, typename Mask>
HWY_INLINE void SolvePoisson(const Inputs<N, Mask>& in, unsigned parts, Solution<N, Mask>& x) {
  const N one = N::Constant(1.0);
  const N& k = in.coefficient;
  x.kappa = k;
  x.one_minus_kappa = one - k;
  x.one_minus_kappa_hat = Numerator<Lead::kS, Power::kOne>(in, x) * x.inverse_s;
  x.one_minus_eta_squared = Numerator<Lead::kS, Power::kTwo>(in, x) * x.inverse_s;
  SolveInverse(parts, x);
  if (parts & (kPartKappaHat | kPartEnergyLoss | kPartEtaSquared)) x.kappa_hat = k * x.d * x.inverse_s;
  if (parts & kPartEta) x.eta = k * Sqrt(x.s * x.d) * x.inverse_s;
  if (parts & kPartEtaSquared) x.eta_squared = k * x.kappa_hat;
  if (parts & kPartEnergyLoss) x.energy_loss = x.one_minus_kappa_hat * (one + x.kappa_hat);
}

// A locked impact has no restitution, whatever the law and the coefficient are.
template <typename N, typename Mask>
HWY_INLINE void OverrideLocked(Solution<N, Mask>& x) {
  if (InNoLane(x.locked)) return;
  const N zero = N::Constant(0.0);
  const N one = N::Constant(1.0);
  x.kappa = Select(x.locked, zero, x.kappa);
  x.kappa_hat = Select(x.locked, zero, x.kappa_hat);
  x.eta = Select(x.locked, zero, x.eta);
  x.eta_squared = Select(x.locked, zero, x.eta_squared);
  x.one_minus_kappa = Select(x.locked, one, x.one_minus_kappa);
  x.inverse_one_plus_kappa = Select(x.locked, one, x.inverse_one_plus_kappa);
  x.one_minus_eta_squared = Select(x.locked, one, x.one_minus_eta_squared);
  x.one_minus_kappa_hat = Select(x.locked, one, x.one_minus_kappa_hat);
  x.energy_loss = Select(x.locked, one, x.energy_loss);
}

template <typename N, typename Mask>
HWY_INLINE void SolveGeometry(const Inputs<N, Mask>& in, Solution<N, Mask>& x) {
  x.inertia = in.inertia;
  x.a = in.a;
  x.b = in.b;
  x.omega = in.omega;
  x.mu = in.mu;
  x.q = x.mu * x.b;
  x.s = AddProduct(x.a, x.mu, x.b);
  x.d = SubtractProduct(x.a, x.mu, x.b);
  x.margin = SubtractProduct(x.a, in.mu_static, x.b);
  x.locked = Not(IsPositive(x.margin));
}

// Sets all quantities to 0, so that those that `parts` leaves out are 0.
template <typename N, typename Mask>
HWY_INLINE void ClearParts(Solution<N, Mask>& x) {
  const N zero = N::Constant(0.0);
  x.kappa = zero;
  x.kappa_hat = zero;
  x.eta = zero;
  x.eta_squared = zero;
  x.one_minus_kappa = zero;
  x.inverse_one_plus_kappa = zero;
  x.one_minus_eta_squared = zero;
  x.one_minus_kappa_hat = zero;
  x.energy_loss = zero;
  x.tau0 = zero;
  x.half_omega_tau0 = zero;
}

// Computes all quantities that `parts` names. If a problem locks, they have no meaning until OverrideLocked sets them.
// The problems must not separate.
template <typename N, typename Mask>
HWY_INLINE void SolveUnlocked(RestitutionLaw law, const Inputs<N, Mask>& in, unsigned parts, Solution<N, Mask>& x) {
  ClearParts(x);
  SolveGeometry(in, x);
  InvertBoth(x.s, x.d, x.inverse_s, x.inverse_d);
  if (parts & kPartTau0) x.tau0 = x.inertia * -x.omega * x.inverse_s;
  if (parts & kPartWork) x.half_omega_tau0 = N::Constant(0.5) * x.omega * x.tau0;
  switch (law) {
    case RestitutionLaw::kNewton:
      SolveNewton(in, parts, x);
      break;
    case RestitutionLaw::kPoisson:
      SolvePoisson(in, parts, x);
      break;
    case RestitutionLaw::kEnergetic:
      SolveEnergetic(in, parts, x);
      break;
  }
}

template <typename N, typename Mask>
HWY_INLINE void SolveParts(RestitutionLaw law, const Inputs<N, Mask>& in, unsigned parts, Solution<N, Mask>& x) {
  SolveUnlocked(law, in, parts, x);
  OverrideLocked(x);
}

// Computes one output and rounds it. Its parts must have been computed.
template <typename N, typename Mask>
HWY_INLINE auto Evaluate(const Solution<N, Mask>& x, Output output) {
  const N one = N::Constant(1.0);
  switch (output) {
    case Output::kNewton:
      return Rounded(x.kappa_hat);
    case Output::kPoisson:
      return Rounded(x.kappa);
    case Output::kEnergetic:
      return Rounded(x.eta);
    case Output::kTangentialCoefficient:
      return RoundedProduct(x.mu * x.one_minus_kappa, x.inverse_one_plus_kappa);
    case Output::kOmegaPlus:
      return RoundedProduct(-x.kappa_hat, x.omega);
    case Output::kTangentialVelocityAfter:
      return RoundedProduct(-x.kappa_hat * x.omega, x.b);
    case Output::kNormalVelocityAfter:
      return RoundedProduct(-x.kappa_hat * x.omega, x.a);
    case Output::kNormalImpulseCompression:
      return Rounded(x.tau0);
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
      return RoundedProduct(N::Constant(-0.5) * x.inertia * x.omega * x.omega, x.energy_loss);
    case Output::kEnergeticExcess:
      return Rounded(-x.one_minus_eta_squared / (one + x.eta));
  }
  return Rounded(N::Constant(0.0));
}

// The inputs of one problem.
template <typename N>
HWY_INLINE Inputs<N, bool> MakeInputs(const Problem& problem) {
  const bool poisson = problem.law == RestitutionLaw::kPoisson;
  return {.inertia = N::Exactly(problem.inertia),
          .a = N::Exactly(problem.a),
          .b = N::Exactly(problem.b),
          .omega = N::Exactly(problem.omega_minus),
          .mu = N::Exactly(SignedFriction(problem)),
          .mu_static = N::Exactly(std::copysign(problem.mu_static, problem.b)),
          .coefficient = N::Exactly(problem.coefficient),
          .near_one = poisson ? problem.coefficient < 2.0 : problem.coefficient > 0.5};
}

}  // namespace ricochet::pendulum::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
