// Random scenes on which the spatial model is held to what it claims of each of its numbers.
//
// The reference of scenes whose slip does not stop, grazing ones among them, shares nothing with the model
// (tests/support/oracles/spatial_oracle.h). That of all others is the one of tests/support/claims/spatial_claims.h.

#ifndef RICOCHET_TESTS_SUPPORT_CLAIMS_SPATIAL_NUMBER_CLAIMS_H_
#define RICOCHET_TESTS_SUPPORT_CLAIMS_SPATIAL_NUMBER_CLAIMS_H_

#include <cmath>
#include <cstdint>
#include <optional>

#include "tests/support/claims/number_claims.h"
#include "tests/support/claims/spatial_claims.h"
#include "tests/support/oracles/spatial_oracle.h"

namespace ricochet::spatial {

// Solves a scene and adds what it claims of its numbers and achieves.
inline void AddNumbers(const Problem& problem, NumberClaims& claims) {
  const Impact reference = HWY_NAMESPACE::Solver<long double>(problem, problem.Delassus().Rank(), 1e-16L).Run();
  const Impact found = Solve(problem);
  const auto at = [](double x) { return Ball(x, 64); };
  const ExactImpact exact = {.u1 = {at(reference.u1[0]), at(reference.u1[1])},
                             .f1 = {at(reference.f1[0]), at(reference.f1[1])},
                             .v1 = at(reference.v1),
                             .tau_compression = at(reference.tau_compression),
                             .tau1 = at(reference.tau1),
                             .work_normal_compression = at(reference.work_normal_compression),
                             .work_normal_restitution = at(reference.work_normal_restitution),
                             .work_tangential_compression = at(reference.work_tangential_compression),
                             .work_tangential_restitution = at(reference.work_tangential_restitution),
                             .energy_change = at(reference.energy_change),
                             .newton = at(reference.newton),
                             .poisson = at(reference.poisson),
                             .energetic = at(reference.energetic),
                             .tangential = at(reference.tangential)};
  claims.Add(found.errors, Compare(found, exact), ToString(problem));
}

inline NumberClaims NumberClaimsOf(bool hard, double tolerance, int count, uint64_t seed) {
  SceneSource source(seed);
  NumberClaims claims;
  for (int i = 0; i < count; ++i) {
    Problem problem = hard ? HardScene(source) : source.Typical();
    problem.tolerance = tolerance;
    AddNumbers(problem, claims);
  }
  return claims;
}

// |v0| is 10^-`least` to 10^-`most` of what it is in typical or nearly singular scenes.
inline Problem GrazingScene(SceneSource& source, bool hard, double least, double most) {
  Problem problem = hard ? source.NearSingular() : source.Typical();
  problem.v0 *= std::pow(10.0, -source.Uniform(least, most));
  return problem;
}

inline NumberClaims GrazingClaimsOf(bool hard, double tolerance, int count, uint64_t seed) {
  SceneSource source(seed);
  NumberClaims claims;
  for (int i = 0; i < count;) {
    Problem problem = GrazingScene(source, hard, 0.0, i % 2 == 0 ? 20.0 : 300.0);
    problem.tolerance = tolerance;
    const std::optional<ExactImpact> exact = SolveExactly(problem);
    if (!exact.has_value()) continue;
    const Impact found = Solve(problem);
    claims.Add(found.errors, Compare(found, *exact), ToString(problem));
    ++i;
  }
  return claims;
}

}  // namespace ricochet::spatial

#endif  // RICOCHET_TESTS_SUPPORT_CLAIMS_SPATIAL_NUMBER_CLAIMS_H_
