// Random scenes on which the planar model is held to what it claims, in plain and in double-double arithmetic.
//
// The reference is a simulation of the events in ball arithmetic (tests/support/oracles/planar_oracle.h).

#ifndef RICOCHET_TESTS_SUPPORT_CLAIMS_PLANAR_CLAIMS_H_
#define RICOCHET_TESTS_SUPPORT_CLAIMS_PLANAR_CLAIMS_H_

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "core/models/planar/planar.h"
#include "tests/support/claims/claims.h"
#include "tests/support/claims/number_claims.h"
#include "tests/support/oracles/arb.h"
#include "tests/support/oracles/planar_oracle.h"
#include "tests/support/scenes/planar_scenes.h"

namespace ricochet::planar {

// A ball that contains 0 is 0, see tests/support/oracles/planar_oracle.h.
inline Ball Distance(double computed, const Ball& exact) {
  const Ball distance = Abs(Ball(computed, 256) - exact);
  return distance.ContainsZero() ? Ball(0.0) : distance;
}

// The sum of the magnitudes of the four works.
inline Ball TotalWork(const ExactImpact& exact) {
  return Abs(exact.work_normal_compression) + Abs(exact.work_normal_restitution) +
         Abs(exact.work_tangential_compression) + Abs(exact.work_tangential_restitution);
}

inline Ball Larger(const Ball& x, const Ball& y) { return x > y ? x : y; }

// The errors that RoundingErrors bounds, each over its scale.
inline RoundingErrors ErrorsReached(const Problem& problem, const Impact& impact, const ExactImpact& exact) {
  const Ball speed = Larger(Abs(Ball(problem.u0)), Abs(Ball(problem.v0)));
  const Ball velocity = Larger(Distance(impact.u1, exact.end().u), Distance(impact.v1, exact.end().v));
  const Ball normal =
      Larger(Distance(impact.tau_compression, exact.tau_compression), Distance(impact.tau1, exact.end().tau));
  const Ball tangential =
      Larger(Distance(impact.f_compression, exact.f_compression), Distance(impact.f1, exact.end().f));
  Ball work = Distance(impact.energy_change, exact.energy_change);
  work = Larger(work, Distance(impact.work_normal_compression, exact.work_normal_compression));
  work = Larger(work, Distance(impact.work_normal_restitution, exact.work_normal_restitution));
  work = Larger(work, Distance(impact.work_tangential_compression, exact.work_tangential_compression));
  work = Larger(work, Distance(impact.work_tangential_restitution, exact.work_tangential_restitution));
  const Ball wnn(problem.w.nn), wtt(problem.w.tt);
  const Ball impulse = Larger(wnn * normal, wtt * tangential);
  const Ball friction = Larger(Abs(exact.f_compression), Abs(exact.end().f));
  return {.velocity = (velocity / speed).UpperBound(),
          .impulse = (impulse / speed).UpperBound(),
          .work = (work / TotalWork(exact)).UpperBound(),
          .counted_impulse = (impulse / Larger(speed, Larger(wnn * exact.end().tau, wtt * friction))).UpperBound()};
}

inline bool AreFinite(const Impact& impact) {
  return std::isfinite(impact.tau1) && std::isfinite(impact.f1) && std::isfinite(impact.f_compression) &&
         std::isfinite(impact.u1) && std::isfinite(impact.v1) && std::isfinite(impact.work_normal_compression) &&
         std::isfinite(impact.work_normal_restitution) && std::isfinite(impact.work_tangential_compression) &&
         std::isfinite(impact.work_tangential_restitution);
}

// Scenes near every threshold, with W of rank one and near it, half of them of sizes between 1e-100 and 1e100.
inline Problem HardScene(SceneSource& source, int i) {
  Problem problem = i % 2 == 0
                        ? source.Any()
                        : source.NearSignChange(static_cast<SceneSource::SignChange>(i / 2 % SceneSource::kSignChanges),
                                                source.NearlyOne());
  if (source.Below(2) == 0) return problem;
  // Powers of two keep the W of a pendulum a product.
  const double speed = std::exp2(std::floor(source.Uniform(-332.0, 332.0)));
  const double mobility = std::exp2(std::floor(source.Uniform(-332.0, 332.0)));
  for (double* velocity : {&problem.u0, &problem.v0}) *velocity *= speed;
  for (double* entry : {&problem.w.tt, &problem.w.tn, &problem.w.nn}) *entry *= mobility;
  return problem;
}

inline ComparedNumbers CompareNumbers(const Impact& impact, const ExactImpact& exact) {
  const ExactInstant& end = exact.end();
  return {.newton = {impact.newton, exact.newton},
          .poisson = {impact.poisson, exact.poisson},
          .energetic = {impact.energetic, exact.energetic},
          .tangential = {impact.tangential, end.f / end.tau},
          .u = {impact.u1, end.u},
          .v = {impact.v1, end.v},
          .tau_compression = {impact.tau_compression, exact.tau_compression},
          .tau = {impact.tau1, end.tau},
          .f = {impact.f1, end.f},
          .work_normal_compression = {impact.work_normal_compression, exact.work_normal_compression},
          .work_normal_restitution = {impact.work_normal_restitution, exact.work_normal_restitution},
          .work_tangential_compression = {impact.work_tangential_compression, exact.work_tangential_compression},
          .work_tangential_restitution = {impact.work_tangential_restitution, exact.work_tangential_restitution},
          .energy_change = {impact.energy_change, exact.energy_change}};
}

struct Claims {
  ClaimTally velocity, impulse, work, largest;

  void Add(const RoundingErrors& claimed, const RoundingErrors& reached, const std::string& scene) {
    largest.Add(claimed.Largest(), reached.Largest(), scene);
    velocity.Add(claimed.velocity, reached.velocity, scene);
    impulse.Add(claimed.impulse, reached.impulse, scene);
    work.Add(claimed.work, reached.work, scene);
  }
};

inline PlainImpact InDoubleDouble(const Problem& problem, ImpactErrors* numbers = nullptr) {
  PlainImpact found = {.proved = true};
  found.impact = Solve(problem, found.errors, numbers);
  return found;
}

inline Problem EverydayScene(SceneSource& source, int /*i*/) { return source.Everyday(); }

// Slip stops in compression, under Poisson's law, and 1 - Wtn^2/(Wtt Wnn) is down to 1e-14.
inline Problem NearlySingularScene(SceneSource& source, int /*i*/) {
  Problem problem = source.Everyday();
  problem.law = RestitutionLaw::kPoisson;
  const double gap = std::pow(10.0, -source.Uniform(10.0, 14.0));
  problem.w.tn = std::copysign(std::sqrt(problem.w.tt * problem.w.nn * (1.0 - gap)), problem.w.tn);
  problem.mu = problem.mu_static = source.Uniform(1.1, 3.0) * std::fabs(problem.w.tn) / problem.w.tt;
  return problem;
}

// `solve` is SolvePlain or InDoubleDouble, `next` gives one scene after another. Nothing is known of an impact that
// plain arithmetic cannot prove or that overflows.
inline Claims ClaimsOf(PlainImpact (*solve)(const Problem& problem, ImpactErrors* numbers),
                       Problem (*next)(SceneSource& source, int i), int count, uint64_t seed) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr RoundingErrors kUnknown = {kInfinity, kInfinity, kInfinity, kInfinity};
  SceneSource source(seed);
  Claims claims;
  for (int i = 0; i < count; ++i) {
    const Problem problem = next(source, i);
    const PlainImpact found = solve(problem, nullptr);
    if (!found.proved || !AreFinite(found.impact)) {
      claims.Add(kUnknown, {}, {});
      continue;
    }
    const ExactImpact exact = SolveExactly(problem);
    const bool same = found.impact.regime == exact.regime;
    claims.Add(found.errors, same ? ErrorsReached(problem, found.impact, exact) : kUnknown, ToString(problem));
  }
  return claims;
}

// Compares the same scenes number by number; with `grazing`, |v0| is down to 1e-300 of |u0|. An impact whose regime is
// not the exact one claims no errors, so that its claims count as broken.
inline NumberClaims NumberClaimsOf(PlainImpact (*solve)(const Problem& problem, ImpactErrors* numbers), bool hard,
                                   bool grazing, int count, uint64_t seed) {
  SceneSource source(seed);
  NumberClaims claims;
  for (int i = 0; i < count; ++i) {
    Problem problem = hard ? HardScene(source, i) : source.Everyday();
    if (grazing) problem.v0 *= std::pow(10.0, -source.Uniform(0.0, 300.0));
    if (problem.v0 == 0.0 || (grazing && problem.w.Rank() == 1)) continue;
    ImpactErrors errors;
    const PlainImpact found = solve(problem, &errors);
    if (!found.proved || !AreFinite(found.impact)) {
      claims.Add({}, {}, {});
      continue;
    }
    const ExactImpact exact = SolveExactly(problem);
    if (found.impact.regime != exact.regime) errors = NoErrors();
    claims.Add(errors, CompareNumbers(found.impact, exact), ToString(problem));
  }
  return claims;
}

}  // namespace ricochet::planar

#endif  // RICOCHET_TESTS_SUPPORT_CLAIMS_PLANAR_CLAIMS_H_
