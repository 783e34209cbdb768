// Random scenes on which the pendulum is held to what it claims, in plain and in double-double arithmetic and to first
// order.
//
// The reference is the paper's formulas in ball arithmetic (tests/support/oracles/pendulum_oracle.h).

#ifndef RICOCHET_TESTS_SUPPORT_CLAIMS_PENDULUM_CLAIMS_H_
#define RICOCHET_TESTS_SUPPORT_CLAIMS_PENDULUM_CLAIMS_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/models/pendulum/first_order.h"
#include "core/models/pendulum/pendulum.h"
#include "tests/support/claims/claims.h"
#include "tests/support/claims/number_claims.h"
#include "tests/support/oracles/arb.h"
#include "tests/support/oracles/pendulum_oracle.h"
#include "tests/support/scenes/pendulum_scenes.h"

namespace ricochet::pendulum {

// The scale of an output's error, as PlainImpact in core/models/pendulum/pendulum.h defines it.
inline Ball ScaleOf(const Problem& problem, const ExactImpact& exact, Output output) {
  const Ball inertia(problem.inertia, 128);
  const Ball a(problem.a, 128);
  const Ball b(std::fabs(problem.b), 128);
  Ball omega(std::fabs(problem.omega_minus), 128);
  Ball velocity = (problem.a > std::fabs(problem.b) ? a : b) * omega;
  const Ball& eta = exact[Output::kEnergetic];
  const Ball least = Ball::PowerOfTwo(-700);
  switch (output) {
    case Output::kNewton:
    case Output::kPoisson:
    case Output::kEnergetic:
      return exact[output] < least ? least : exact[output];
    case Output::kTangentialCoefficient:
      return Ball(problem.mu) < least ? least : Ball(problem.mu);
    case Output::kOmegaPlus:
      return omega;
    case Output::kTangentialVelocityAfter:
    case Output::kNormalVelocityAfter:
      return velocity;
    case Output::kNormalImpulseCompression:
    case Output::kNormalImpulse:
      return velocity * inertia / (a * a);
    case Output::kTangentialImpulse:
    case Output::kTangentialImpulseCompression:
      return problem.b == 0.0 ? Ball(0.0) : velocity * inertia / (b * b);
    case Output::kWorkNormalCompression:
    case Output::kWorkNormalRestitution:
    case Output::kWorkTangentialCompression:
    case Output::kWorkTangentialRestitution:
    case Output::kWorkNormal:
    case Output::kWorkTangential:
    case Output::kEnergyChange:
      return 0.5 * inertia * omega * omega * (1.0 + eta * eta);
    case Output::kEnergeticExcess:
      return 1.0 + eta;
  }
  return Ball(0.0);
}

// The largest error of an output over its scale; infinite where the regime or a broken limit is not the exact one. An
// output whose scale is 0 has to be exact.
inline double AchievedError(const Problem& problem, const Impact& impact, const ExactImpact& exact) {
  const bool same = impact.regime == exact.regime && impact.sharp_limit_broken == exact.sharp_limit_broken &&
                    impact.energy_limit_broken == exact.energy_limit_broken;
  if (!same) return std::numeric_limits<double>::infinity();
  double worst = 0.0;
  if (exact.regime == Regime::kSeparating) return worst;  // A test of its own covers it.
  for (int i = 0; i < kOutputCount; ++i) {
    const auto output = static_cast<Output>(i);
    const Ball error = Abs(Ball(impact[output], 256) - exact[output]);
    if (error.IsExact() && error.ContainsZero()) continue;
    const double relative = (error / ScaleOf(problem, exact, output)).UpperBound();
    worst = std::isnan(relative) ? std::numeric_limits<double>::infinity() : std::max(worst, relative);
  }
  return worst;
}

// Sizes at and beyond the ends of the range that plain arithmetic serves, and numbers that are almost 0.
inline Problem OfExtremeSize(SceneSource& source, Problem problem) {
  const auto scale = [&source] { return std::exp2(source.Sign() * source.Uniform(90.0, 101.0)); };
  problem.inertia *= scale();
  problem.omega_minus *= scale();
  if (source.Sign() > 0.0) {
    const double lengths = scale();
    problem.a *= lengths;
    problem.b *= lengths;
  }
  if (source.Sign() > 0.0) problem.coefficient *= std::exp2(-source.Uniform(0.0, 1074.0));
  if (source.Sign() > 0.0) problem.b *= std::exp2(-source.Uniform(0.0, 1074.0));
  if (source.Sign() > 0.0) problem.mu *= std::exp2(-source.Uniform(0.0, 1074.0));
  return problem;
}

// Near every threshold, and at scales of 10^+-100.
inline Problem HardScene(SceneSource& source, int i) {
  if (i % 2 == 0) return source.Any();
  const Problem problem = source.NearSignChange(static_cast<SceneSource::SignChange>(i / 2 % SceneSource::kSignChanges),
                                                source.NearlyOne());
  return i % 3 == 0 ? OfExtremeSize(source, problem) : problem;
}

// Scenes that plain arithmetic leaves to double-double arithmetic count as unknown.
inline ClaimTally PlainClaims(bool hard, int count, uint64_t seed) {
  SceneSource source(seed);
  ClaimTally tally;
  for (int i = 0; i < count; ++i) {
    const Problem problem = hard ? HardScene(source, i) : source.Everyday();
    const PlainImpact plain = SolvePlain(problem);
    const double claimed = plain.proved ? plain.relative_error : std::numeric_limits<double>::infinity();
    tally.Add(claimed, AchievedError(problem, plain.impact, SolveExactly(problem)), ToString(problem));
  }
  return tally;
}

// Each output claims an ulp of itself, 2^-52, beyond the 2^-100 of its scale of an output that changes its sign.
inline ClaimTally CompensatedClaims(bool hard, int count, uint64_t seed) {
  constexpr double kUlp = 0x1p-52;
  SceneSource source(seed);
  ClaimTally tally;
  for (int i = 0; i < count; ++i) {
    const Problem problem = hard ? HardScene(source, i) : source.Everyday();
    const ExactImpact exact = SolveExactly(problem);
    const Impact impact = Solve(problem);
    double worst = impact.regime == exact.regime ? 0.0 : std::numeric_limits<double>::infinity();
    for (size_t k = 0; k < kOutputCount && exact.regime != Regime::kSeparating; ++k) {
      worst = std::max(worst, kUlp * OutputError(exact, k, impact.values[k]));
    }
    tally.Add(kUlp, worst, ToString(problem));
  }
  return tally;
}

inline ComparedNumbers CompareNumbers(const Impact& impact, const ExactImpact& exact) {
  const auto of = [&](Output output) { return ComparedNumber(impact[output], exact[output]); };
  return {.newton = of(Output::kNewton),
          .poisson = of(Output::kPoisson),
          .energetic = of(Output::kEnergetic),
          .tangential = of(Output::kTangentialCoefficient),
          .u = of(Output::kTangentialVelocityAfter),
          .v = of(Output::kNormalVelocityAfter),
          .tau_compression = of(Output::kNormalImpulseCompression),
          .tau = of(Output::kNormalImpulse),
          .f = of(Output::kTangentialImpulse),
          .work_normal_compression = of(Output::kWorkNormalCompression),
          .work_normal_restitution = of(Output::kWorkNormalRestitution),
          .work_tangential_compression = of(Output::kWorkTangentialCompression),
          .work_tangential_restitution = of(Output::kWorkTangentialRestitution),
          .energy_change = of(Output::kEnergyChange)};
}

// Compares impacts number by number, in plain or in double-double arithmetic.
inline NumberClaims NumberClaimsOf(bool is_plain, bool hard, int count, uint64_t seed) {
  SceneSource source(seed);
  NumberClaims claims;
  for (int i = 0; i < count; ++i) {
    const Problem problem = hard ? HardScene(source, i) : source.Everyday();
    const PlainImpact plain = is_plain ? SolvePlain(problem) : PlainImpact{.impact = Solve(problem), .proved = true};
    if (!plain.proved) {
      claims.Add({}, {}, {});
      continue;
    }
    const ImpactErrors errors = is_plain ? PlainErrorsOf(problem, plain) : ErrorsOf(problem, plain.impact);
    claims.Add(errors, CompareNumbers(plain.impact, SolveExactly(problem)), ToString(problem));
  }
  return claims;
}

}  // namespace ricochet::pendulum

namespace ricochet::first_order {

// x = mu |b|/a lies anywhere between 1e-8 and its limit, and at the limit itself in one scene of 100. In hard scenes
// the coefficient also lies at an end of its range, and inertia, lengths and velocity at up to 10^+-100.
inline Problem ServedScene(pendulum::SceneSource& source, bool hard) {
  for (;;) {
    Problem problem = {.inertia = source.Uniform(0.1, 10.0),
                       .a = source.Uniform(0.1, 10.0),
                       .b = source.Sign() * std::exp2(source.Uniform(-8.0, 8.0)),
                       .omega_minus = -source.Uniform(0.1, 10.0),
                       .law = source.AnyLaw()};
    const double x =
        source.Below(100) == 0 ? kLargestX * (1.0 - 0x1p-40) : std::pow(10.0, source.Uniform(-8.0, std::log10(0.5)));
    const double largest = problem.law == RestitutionLaw::kNewton    ? 1.0 - x
                           : problem.law == RestitutionLaw::kPoisson ? 1.0 + x
                                                                     : 1.0;
    const bool at_end = hard && source.Below(4) == 0;
    const double share = at_end ? static_cast<double>(source.Below(2)) : source.Uniform(0.0, 1.0);
    problem.coefficient = share * largest * (1.0 - 0x1p-40);
    if (hard) {
      problem.inertia *= std::exp2(source.Uniform(-100.0, 100.0));
      problem.omega_minus *= std::exp2(source.Uniform(-100.0, 100.0));
      const double length = std::exp2(source.Uniform(-90.0, 90.0));
      problem.a *= length;
      problem.b *= length;
    }
    problem.mu = problem.mu_static = x * problem.a / std::fabs(problem.b);
    if (Serves(problem)) return problem;
  }
}

// The largest error of the velocities, and of the impulses times their mobilities, over max(|u0|, |v0|).
inline RelativeErrors ErrorsReached(const Problem& p, const Impact& impact, const pendulum::ExactImpact& exact) {
  const Ball inertia(p.inertia, 128);
  const Ball a(p.a, 128);
  const Ball b(p.b, 128);
  const Ball speed = Ball(std::max(p.a, std::fabs(p.b)), 128) * Ball(-p.omega_minus);
  const auto error = [&](Output output) { return Abs(Ball(impact[output], 256) - exact[output]); };
  const auto reached = [&](const Ball& mobility, Output one, Output other) {
    return std::max((mobility * error(one) / speed).UpperBound(), (mobility * error(other) / speed).UpperBound());
  };
  return {
      .velocity = reached(Ball(1.0), Output::kTangentialVelocityAfter, Output::kNormalVelocityAfter),
      .impulse = std::max(reached(a * a / inertia, Output::kNormalImpulse, Output::kNormalImpulseCompression),
                          reached(b * b / inertia, Output::kTangentialImpulse, Output::kTangentialImpulseCompression))};
}

struct Claims {
  ClaimTally velocity, impulse;
};

inline Claims ClaimsOf(bool hard, int count, uint64_t seed) {
  pendulum::SceneSource source(seed);
  Claims claims;
  for (int i = 0; i < count; ++i) {
    const Problem problem = ServedScene(source, hard);
    const RelativeErrors claimed = ErrorsOf(problem);
    const RelativeErrors reached = ErrorsReached(problem, first_order::Solve(problem), pendulum::SolveExactly(problem));
    claims.velocity.Add(claimed.velocity, reached.velocity, pendulum::ToString(problem));
    claims.impulse.Add(claimed.impulse, reached.impulse, pendulum::ToString(problem));
  }
  return claims;
}

// Compares first-order impacts number by number; without `friction` the problems have none.
inline NumberClaims NumberClaimsOf(bool friction, bool hard, int count, uint64_t seed) {
  pendulum::SceneSource source(seed);
  NumberClaims claims;
  for (int i = 0; i < count; ++i) {
    Problem problem = ServedScene(source, hard);
    if (!friction) problem.mu = problem.mu_static = 0.0;
    const Impact impact = first_order::Solve(problem);
    claims.Add(NumberErrorsOf(problem, impact), pendulum::CompareNumbers(impact, pendulum::SolveExactly(problem)),
               pendulum::ToString(problem));
  }
  return claims;
}

}  // namespace ricochet::first_order

#endif  // RICOCHET_TESTS_SUPPORT_CLAIMS_PENDULUM_CLAIMS_H_
