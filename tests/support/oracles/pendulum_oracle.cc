#include "tests/support/oracles/pendulum_oracle.h"

#include <cmath>
#include <cstdlib>

namespace ricochet::pendulum {
namespace {

constexpr std::array<slong, 3> kPrecisions = {256, 1024, 8192};

double SignOf(double x) { return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : 0.0; }

// a, |b|, mu and the quantities that depend on them alone, with `bits` of precision.
struct Geometry {
  Geometry(const Problem& problem, slong bits)
      : a(problem.a, bits),
        mu(problem.mu, bits),
        q(mu * Ball(std::fabs(problem.b), bits)),
        sum(a + q),
        difference(a - q) {}

  Ball a, mu, q, sum, difference;
};

bool Locks(const Problem& problem) {
  return Ball(problem.mu_static, Ball::kExact) * Ball(std::fabs(problem.b)) >= Ball(problem.a);
}

Regime RegimeOf(const Problem& problem) {
  if (problem.omega_minus >= 0.0) return Regime::kSeparating;
  if (Locks(problem)) return Regime::kLocked;
  return problem.mu == 0.0 || problem.b == 0.0 ? Regime::kFrictionless : Regime::kRebound;
}

// The limits [29] and [27], with roots and quotients multiplied out, so that both sides are exact.
void DecideLimits(const Problem& problem, ExactImpact& impact) {
  const Geometry g(problem, Ball::kExact);
  const Ball c(problem.coefficient, Ball::kExact);
  switch (problem.law) {
    case RestitutionLaw::kNewton:
      impact.sharp_limit_broken = c * c * g.sum > g.difference;
      impact.energy_limit_broken = c > Ball(1.0);
      break;
    case RestitutionLaw::kPoisson:
      impact.sharp_limit_broken = c * c * g.difference > g.sum;
      impact.energy_limit_broken = c * g.difference > g.sum;
      break;
    case RestitutionLaw::kEnergetic:
      impact.sharp_limit_broken = c > Ball(1.0);
      impact.energy_limit_broken = c * c * g.difference > g.sum;
      break;
  }
}

struct Coefficients {
  Ball newton, poisson, energetic;
};

// Converts the stated coefficient to all three by [15], [24] and [25].
Coefficients Convert(const Problem& problem, const Ball& r, slong bits) {
  const Ball c(problem.coefficient, bits);
  switch (problem.law) {
    case RestitutionLaw::kNewton:
      return {c, c / r, Sqrt(c * (c / r))};
    case RestitutionLaw::kPoisson:
      return {r * c, c, Sqrt(c * (r * c))};
    case RestitutionLaw::kEnergetic:
      return {Sqrt(r) * c, Sqrt(1.0 / r) * c, c};
  }
  std::abort();
}

void Evaluate(const Problem& problem, slong bits, ExactImpact& impact) {
  const Geometry g(problem, bits);
  const Ball r = g.difference / g.sum;
  const Ball b(problem.b, bits);
  const Ball inertia(problem.inertia, bits);
  const Ball omega(problem.omega_minus, bits);
  const bool locked = impact.regime == Regime::kLocked;
  const Coefficients c = locked ? Coefficients() : Convert(problem, r, bits);

  const Ball sign(SignOf(problem.b));
  const Ball tau0 = -(inertia * omega) / g.sum;         // [8]
  const Ball tau1 = (1.0 + c.poisson) * tau0;           // [10]
  const Ball omega_plus = -(c.newton * omega);          // [14]
  const Ball f1 = sign * (g.mu * (2.0 * tau0 - tau1));  // [48]
  const Ball wc_n = 0.5 * g.a * tau0 * omega;           // [22]
  const Ball wr_n = 0.5 * c.poisson * g.a * tau0 * omega_plus;
  const Ball wc_t = 0.5 * g.q * tau0 * omega;  // [34]
  const Ball wr_t = -(0.5 * g.q * c.poisson * tau0 * omega_plus);
  const Ball energy_lost = 0.5 * inertia * (omega * omega - omega_plus * omega_plus);  // [16]

  const auto set = [&impact](Output output, Ball value, Ball scale = Ball(0.0)) {
    impact.values[static_cast<size_t>(output)] = std::move(value);
    impact.scales[static_cast<size_t>(output)] = std::move(scale);
  };
  set(Output::kNewton, c.newton);
  set(Output::kPoisson, c.poisson);
  set(Output::kEnergetic, c.energetic);
  set(Output::kTangentialCoefficient, f1 / tau1, g.mu);  // [49]
  set(Output::kOmegaPlus, omega_plus);
  set(Output::kTangentialVelocityAfter, b * omega_plus);
  set(Output::kNormalVelocityAfter, g.a * omega_plus);
  set(Output::kNormalImpulseCompression, tau0);
  set(Output::kNormalImpulse, tau1);
  set(Output::kTangentialImpulse, f1, g.mu * tau0);
  set(Output::kTangentialImpulseCompression, sign * (g.mu * tau0));
  set(Output::kWorkNormalCompression, wc_n);
  set(Output::kWorkNormalRestitution, wr_n);
  set(Output::kWorkTangentialCompression, wc_t);
  set(Output::kWorkTangentialRestitution, wr_t);
  set(Output::kWorkNormal, wc_n + wr_n, -wc_n);  // [36]
  set(Output::kWorkTangential, wc_t + wr_t);     // [35]
  set(Output::kEnergyChange, -energy_lost, 0.5 * inertia * omega * omega);
  set(Output::kEnergeticExcess, c.energetic - 1.0, Ball(1.0));
}

bool IsKnown(const Ball& value, const Ball& scale, bool granted) {
  if (value.IsExact() || value.RelativeAccuracyBits() >= 100) return true;
  return granted && value.Radius() <= Ball::PowerOfTwo(-170) * scale;
}

// If the stated coefficient is the output's own, the difference is exact, and its sign is right.
bool IsGranted(const Problem& problem, Output output) {
  switch (output) {
    case Output::kTangentialCoefficient:
    case Output::kTangentialImpulse:
      return problem.law != RestitutionLaw::kPoisson;
    case Output::kWorkNormal:
    case Output::kEnergeticExcess:
      return problem.law != RestitutionLaw::kEnergetic;
    case Output::kEnergyChange:
      return problem.law == RestitutionLaw::kPoisson;
    default:
      return false;
  }
}

// The contact separates: nothing happens.
void SetUnchanged(const Problem& problem, ExactImpact& impact) {
  const auto set = [&impact](Output output, const Ball& value) { impact.values[static_cast<size_t>(output)] = value; };
  const Ball omega(problem.omega_minus, Ball::kExact);
  set(Output::kOmegaPlus, omega);
  set(Output::kTangentialVelocityAfter, Ball(problem.b) * omega);
  set(Output::kNormalVelocityAfter, Ball(problem.a) * omega);
  set(Output::kEnergeticExcess, Ball(-1.0));
}

ExactBounds EvaluateBounds(const Problem& problem, slong bits) {
  const Geometry g(problem, bits);
  const Ball one(1.0);
  const double sign = SignOf(problem.b);
  ExactBounds bounds;
  bounds.regime = RegimeOf(problem);
  bounds.friction_ratio = g.q / g.a;
  bounds.slope_ratio = g.difference / g.sum;
  if (bounds.regime == Regime::kSeparating) return bounds;

  const Ball tau0 = -(Ball(problem.inertia, bits) * problem.omega_minus) / g.sum;
  const auto tangential = [&](const Ball& least) {
    if (sign == 0.0) return ExactRange();
    return sign > 0.0 ? ExactRange{least, g.mu} : ExactRange{-g.mu, -least};
  };
  if (bounds.regime == Regime::kLocked) {
    bounds.sharp.tangential = tangential(g.mu);
    bounds.sharp.normal_total = {tau0, tau0};
    bounds.energy_only = bounds.sharp;
    return bounds;
  }
  const Ball& r = bounds.slope_ratio;
  const Ball& x = bounds.friction_ratio;
  const Ball kappa = Sqrt(1.0 / r);
  // [55], divided by |b| only if b is not 0.
  const Ball least = sign == 0.0 ? Ball(0.0) : -(g.a / std::fabs(problem.b) * (1.0 - Sqrt(1.0 - x * x)));
  bounds.sharp = {{0.0, Sqrt(r)}, {0.0, kappa}, {0.0, one}, tangential(least), {tau0, (1.0 + kappa) * tau0}};
  // [27], [28]; the others follow from Poisson's by [24], [51] and [10].
  const Ball weak = 1.0 / r;
  bounds.energy_only = {{0.0, one},
                        {0.0, weak},
                        {0.0, Sqrt(weak)},
                        tangential(g.mu * (1.0 - weak) / (1.0 + weak)),
                        {tau0, (1.0 + weak) * tau0}};
  return bounds;
}

}  // namespace

ExactImpact SolveExactly(const Problem& problem) {
  ExactImpact impact;
  impact.regime = RegimeOf(problem);
  if (impact.regime == Regime::kSeparating) {
    SetUnchanged(problem, impact);
    return impact;
  }
  if (impact.regime != Regime::kLocked) DecideLimits(problem, impact);
  for (const slong bits : kPrecisions) {
    Evaluate(problem, bits, impact);
    bool known = true;
    for (size_t i = 0; i < kOutputCount; ++i) {
      const bool granted = IsGranted(problem, static_cast<Output>(i));
      known = known && IsKnown(impact.values[i], impact.scales[i], granted);
    }
    if (known) break;
  }
  for (size_t i = 0; i < kOutputCount; ++i) {
    // A difference of these inputs that is so small is 0.
    const bool is_zero =
        impact.values[i].ContainsZero() && impact.values[i].Radius() <= Ball::PowerOfTwo(-6000) * impact.scales[i];
    if (is_zero) impact.values[i] = Ball(0.0);
    if (!IsGranted(problem, static_cast<Output>(i))) impact.scales[i] = Ball(0.0);
  }
  return impact;
}

double OutputError(const ExactImpact& exact, size_t i, double computed) {
  return ErrorInUlps(computed, exact.values[i], Ball::PowerOfTwo(-100) * exact.scales[i]);
}

ExactInstant ExactlyAt(const Problem& problem, double tau) {
  constexpr slong kBits = 1024;
  const Geometry g(problem, kBits);
  const Ball omega(problem.omega_minus, kBits);
  const Ball sign(SignOf(problem.b));
  const Ball tau0 = -(Ball(problem.inertia) * omega) / g.sum;
  ExactInstant instant;
  instant.omega_scale = Abs(omega);
  instant.impulse_scale = g.mu * tau0;
  const Ball rest = 1.0 - tau / tau0;
  if (Ball(tau) > tau0) {
    instant.omega = g.difference / g.sum * rest * omega;              // [9]
    instant.tangential_impulse = sign * (g.mu * (2.0 * tau0 - tau));  // [48]
  } else {
    instant.omega = rest * omega;
    instant.tangential_impulse = sign * (g.mu * tau);
  }
  return instant;
}

ExactBounds SolveBoundsExactly(const Problem& problem) {
  ExactBounds bounds;
  for (const slong bits : kPrecisions) {
    bounds = EvaluateBounds(problem, bits);
    // Only 1 - sqrt(1 - x^2) and a - mu |b| cancel.
    const auto known = [](const Ball& ball) { return ball.IsExact() || ball.RelativeAccuracyBits() >= 100; };
    const ExactRange& tangential = bounds.sharp.tangential;
    if (known(tangential.lower) && known(tangential.upper) && known(bounds.slope_ratio)) break;
  }
  return bounds;
}

const std::array<const char*, kOutputCount>& OutputNames() {
  static constexpr std::array<const char*, kOutputCount> kNames = {"newton",
                                                                   "poisson",
                                                                   "energetic",
                                                                   "mu_hat",
                                                                   "omega_plus",
                                                                   "u_plus",
                                                                   "v_plus",
                                                                   "tau0",
                                                                   "tau1",
                                                                   "f1",
                                                                   "f0",
                                                                   "work_n_compression",
                                                                   "work_n_restitution",
                                                                   "work_t_compression",
                                                                   "work_t_restitution",
                                                                   "work_n",
                                                                   "work_t",
                                                                   "energy_change",
                                                                   "energetic_excess"};
  return kNames;
}

}  // namespace ricochet::pendulum
