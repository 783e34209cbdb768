// This file is compiled once for each SIMD target (foreach_target.h includes it again). The target is chosen at run
// time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/models/pendulum/pendulum.cc"
#include "core/models/pendulum/pendulum.h"

#include <cstddef>
#include <utility>

#include "core/models/pendulum/parts.h"
#include "core/numerics/moderate.h"
// Highway prescribes the order of these includes.
// clang-format off
#include "hwy/foreach_target.h"
#include "core/models/pendulum/kernel-inl.h"
#include "core/models/pendulum/rounding-inl.h"
#include "core/numerics/plain-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace ricochet::pendulum::HWY_NAMESPACE {

// Adding 0 turns -0 into 0: an impulse or velocity that vanishes has no sign.
HWY_INLINE double Unsigned0(double value) { return value + 0.0; }

// The numbers of the outputs are constants here, so that none is told from the others at run time.
template <typename T, size_t... kOutputs>
HWY_INLINE void EvaluateAll(const Solution<T, bool>& x, Impact& impact, std::index_sequence<kOutputs...> /*all*/) {
  ((impact.values[kOutputs] = Unsigned0(Evaluate(x, static_cast<Output>(kOutputs)))), ...);
}

template <typename T>
HWY_INLINE Impact ImpactOf(const Problem& problem, const Solution<T, bool>& x) {
  Impact impact;
  impact.regime = RegimeOf(problem, x.locked);
  impact.sharp_limit_broken = IsNegative(x.one_minus_eta_squared);
  impact.energy_limit_broken = IsNegative(x.one_minus_kappa_hat);
  EvaluateAll(x, impact, std::make_index_sequence<kOutputCount>());
  return impact;
}

template <typename T>
HWY_INLINE Impact SolveOne(const Problem& problem) {
  Solution<T, bool> x;
  SolveParts(problem.law, MakeInputs<T>(problem), kPartAll, x);
  return ImpactOf(problem, x);
}

Impact SolveModerate(const Problem& problem) {
  return SolveOne<ricochet::HWY_NAMESPACE::DoubleDouble<double>>(problem);
}

// The problem must not separate.
void SolvePlainly(const Problem& problem, PlainImpact& plain) {
  const auto in = MakeInputs<Plain<double>>(problem);
  plain.proved = IsModerate(in);
  if (!plain.proved) return;
  Solution<Plain<double>, bool> x;
  SolveParts(problem.law, in, kPartAll, x);
  plain.relative_error = RelativeError(x);
  plain.proved = SignsAreProved(problem.law, x) && plain.relative_error < 1.0;
  if (!plain.proved) return;
  plain.impact = ImpactOf(problem, x);
}

}  // namespace ricochet::pendulum::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include "core/models/pendulum/wide.h"

namespace ricochet::pendulum {

HWY_EXPORT(SolveModerate);
HWY_EXPORT(SolvePlainly);

namespace {

using HWY_NAMESPACE::kCoefficientLimit;
using HWY_NAMESPACE::kLimit;

bool FitsDoubleDouble(const Problem& problem) {
  return AreModerate({problem.inertia, problem.a, problem.b, problem.omega_minus, problem.mu, problem.mu_static},
                     kLimit) &&
         AreModerate({problem.coefficient}, kCoefficientLimit);
}

bool Separating(const Problem& problem) { return problem.omega_minus >= 0.0; }

// The output for a contact that does not approach: velocities stay the same, all other outputs are 0.
double SeparatingOutput(const Problem& problem, Output output) {
  switch (output) {
    case Output::kOmegaPlus:
      return problem.omega_minus;
    case Output::kTangentialVelocityAfter:
      return problem.b * problem.omega_minus;
    case Output::kNormalVelocityAfter:
      return problem.a * problem.omega_minus;
    case Output::kEnergeticExcess:
      return -1.0;
    default:
      return 0.0;
  }
}

Impact SolveSeparating(const Problem& problem) {
  Impact impact;
  impact.regime = Regime::kSeparating;
  for (int i = 0; i < kOutputCount; ++i) {
    impact.values[static_cast<size_t>(i)] = SeparatingOutput(problem, static_cast<Output>(i));
  }
  return impact;
}

}  // namespace

Impact Solve(const Problem& problem) {
  if (Separating(problem)) return SolveSeparating(problem);
  if (!FitsDoubleDouble(problem)) return HWY_NAMESPACE::SolveOne<Wide>(problem);
  return HWY_DYNAMIC_DISPATCH(SolveModerate)(problem);
}

PlainImpact SolvePlain(const Problem& problem) {
  PlainImpact plain;
  if (Separating(problem)) {
    plain.impact = SolveSeparating(problem);
    plain.relative_error = HWY_NAMESPACE::kUnitRoundoff;
    plain.proved = true;
  } else {
    HWY_DYNAMIC_DISPATCH(SolvePlainly)(problem, plain);
  }
  return plain;
}

Instant At(const Problem& problem, double tau) {
  const WideSolution x = SolveGeometry(problem);
  const Wide momentum = x.inertia * x.omega;
  const Wide impulse = Wide::Exactly(tau);
  // J omega(tau) in compression. From the end of compression on the slope is d instead of s.
  const Wide compression = momentum + x.s * impulse;
  if (!IsPositive(compression)) {
    return {Rounded(compression / x.inertia) + 0.0, Rounded(x.mu * impulse) + 0.0};
  }
  const Wide two = Wide::Constant(2.0);
  return {Rounded(x.d / x.s * compression / x.inertia) + 0.0,
          Rounded(-x.mu * (two * momentum + x.s * impulse) / x.s) + 0.0};
}

}  // namespace ricochet::pendulum

#endif  // HWY_ONCE
