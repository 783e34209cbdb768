// Random scenes on which the compliant model is held to what it claims.
//
// The reference is the equations in time by Taylor series at 58 digits (tests/support/oracles/compliant_oracle.h).

#ifndef RICOCHET_TESTS_SUPPORT_CLAIMS_COMPLIANT_CLAIMS_H_
#define RICOCHET_TESTS_SUPPORT_CLAIMS_COMPLIANT_CLAIMS_H_

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "core/models/compliant/compliant.h"
#include "tests/support/claims/claims.h"
#include "tests/support/claims/number_claims.h"
#include "tests/support/oracles/compliant_oracle.h"
#include "tests/support/scenes/compliant_hard_scenes.h"
#include "tests/support/scenes/compliant_scenes.h"

namespace ricochet::compliant {

// Near one of the places where paths fork or degenerate.
inline Problem NearAFork(SceneSource& source) {
  using Change = void (*)(SceneSource & source, Problem & problem);
  constexpr Change kChanges[] = {StartOnTheCone,
                                 StartOnTheConeWithoutGrowth,
                                 CriticalFriction,
                                 NoLift,
                                 StopAtTheEndOfCompression,
                                 StopAtTheEndOfContact,
                                 EqualFrequencies,
                                 NearlyARod,
                                 UnequalMasses,
                                 UnequalMobilities};
  const int kind = source.Below(12);
  if (kind == 10) return Fork(source);
  if (kind == 11) return Rod(source);
  Problem problem = Everyday(source);
  kChanges[kind](source, problem);
  return problem;
}

// Scenes near every threshold, near rank one and of unequal numbers, half of them of sizes between 1e-100 and 1e100.
inline Problem HardScene(SceneSource& source) {
  Problem problem;
  switch (source.Below(8)) {
    case 0:
      problem = source.RankOne();
      break;
    case 1:
      problem = source.NearRankOne();
      break;
    case 2:
      problem = source.AnySizes();
      break;
    case 3:
      problem = source.Everyday(1e-3, 1e3);
      break;
    default:
      problem = NearAFork(source);
  }
  if (source.Below(2) == 0) return problem;
  // Powers of two keep products of rank one.
  const double speed = std::exp2(std::floor(source.Uniform(-332.0, 332.0)));
  const double mobility = std::exp2(std::floor(source.Uniform(-332.0, 332.0)));
  for (double* velocity : {&problem.contact.u0, &problem.contact.v0}) *velocity *= speed;
  for (double* entry : {&problem.contact.w.tt, &problem.contact.w.tn, &problem.contact.w.nn}) *entry *= mobility;
  return problem;
}

// The reference takes 20 ms a scene of everyday length, and minutes where the path has hundreds of sections.
inline constexpr size_t kMostSections = 50;

inline ClaimTally ClaimsOf(bool hard, int count, uint64_t seed) {
  SceneSource source(seed);
  ClaimTally tally;
  while (tally.count() < count) {
    const Problem problem = hard ? HardScene(source) : source.Everyday(0.02, 50.0);
    const Impact impact = Solve(problem);
    if (!impact.Converged()) {
      tally.Add(impact.error_estimate, 0.0);
      continue;
    }
    if (impact.sections.size() > kMostSections) continue;
    const ExactImpact exact = SolveExactly(problem);
    const double achieved =
        exact.ends ? VelocityError(problem, impact.u1, impact.v1, exact) : std::numeric_limits<double>::infinity();
    tally.Add(impact.error_estimate, achieved, ToString(problem));
  }
  return tally;
}

// Compares impacts number by number. The oracle knows only the whole tangential work.
inline NumberClaims NumberClaimsOf(bool hard, int count, uint64_t seed) {
  SceneSource source(seed);
  NumberClaims claims;
  while (claims.velocity.count() < 2 * count) {
    const Problem problem = hard ? HardScene(source) : source.Everyday(0.02, 50.0);
    const Impact impact = Solve(problem);
    if (impact.sections.size() > kMostSections) continue;
    if (!impact.Converged()) {
      claims.Add({}, {}, {});
      continue;
    }
    const ExactImpact exact = SolveExactly(problem);
    if (!exact.ends) continue;
    const Ball work_t = exact.energy_change - exact.work_normal;
    const Ball zero(0.0);
    const bool returns = problem.contact.coefficient > 0.0;
    const ComparedNumbers found = {
        .newton = {impact.newton, returns ? -(exact.v1 / Ball(problem.contact.v0, 192)) : zero},
        .poisson = {impact.poisson, returns ? (exact.tau1 - exact.tau_compression) / exact.tau_compression : zero},
        .energetic = {impact.energetic, Ball(problem.contact.coefficient)},
        .tangential = {impact.tangential, exact.f1 / exact.tau1},
        .u = {impact.u1, exact.u1},
        .v = {impact.v1, exact.v1},
        .tau_compression = {impact.tau_compression, exact.tau_compression},
        .tau = {impact.tau1, exact.tau1},
        .f = {impact.f1, exact.f1},
        .work_normal_compression = {impact.work_normal_compression, exact.work_normal_compression},
        .work_normal_restitution = {impact.work_normal_restitution, exact.work_normal_restitution},
        .work_tangential_compression = {},
        .work_tangential_restitution = {impact.work_tangential_compression + impact.work_tangential_restitution,
                                        work_t},
        .energy_change = {impact.energy_change, exact.energy_change}};
    ImpactErrors errors = impact.errors;
    errors.work_tangential_restitution += errors.work_tangential_compression;
    claims.Add(errors, found, ToString(problem));
  }
  return claims;
}

}  // namespace ricochet::compliant

#endif  // RICOCHET_TESTS_SUPPORT_CLAIMS_COMPLIANT_CLAIMS_H_
