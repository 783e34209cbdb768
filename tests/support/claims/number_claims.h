// NumberClaims: the errors that a model claims of each of its numbers, held against the errors that it makes.
//
// Both are divided by the number's exact size, so that each is judged on its own scale; a number that is exactly 0 is
// judged by whether its claim covers its error. Impacts of all models are compared as ImpactErrors are.

#ifndef RICOCHET_TESTS_SUPPORT_CLAIMS_NUMBER_CLAIMS_H_
#define RICOCHET_TESTS_SUPPORT_CLAIMS_NUMBER_CLAIMS_H_

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "core/models/impact_errors.h"
#include "tests/support/claims/claims.h"
#include "tests/support/oracles/arb.h"

namespace ricochet {

// A number as it was computed, and as it is. A vector has one error, that of its worst component.
struct ComparedNumber {
  double reached = 0.0;  // its error
  double size = 0.0;     // its exact size

  ComparedNumber() = default;
  ComparedNumber(double its_reached, double its_size) : reached(its_reached), size(its_size) {}
  // A ball that contains 0 is 0: oracles compute far more digits than they are asked for.
  ComparedNumber(double computed, const Ball& exact) : size(Abs(exact).UpperBound()) {
    reached = std::numeric_limits<double>::infinity();
    if (!std::isfinite(computed)) return;
    const Ball distance = Abs(Ball(computed, 512) - exact);
    reached = distance.ContainsZero() ? 0.0 : distance.UpperBound();
  }
  ComparedNumber(const std::array<double, 2>& computed, const std::array<Ball, 2>& exact)
      : ComparedNumber(computed[0], exact[0]) {
    const ComparedNumber second(computed[1], exact[1]);
    reached = std::max(reached, second.reached);
    size = std::max(size, second.size);
  }
};

struct ComparedNumbers {
  ComparedNumber newton, poisson, energetic, tangential, u, v, tau_compression, tau, f;
  ComparedNumber work_normal_compression, work_normal_restitution;
  ComparedNumber work_tangential_compression, work_tangential_restitution, energy_change;
};

// Compares an impact with an exact one, whose members have the names of ImpactEnd's.
template <typename Impact, typename Exact>
ComparedNumbers Compare(const Impact& impact, const Exact& exact) {
  return {.newton = {impact.newton, exact.newton},
          .poisson = {impact.poisson, exact.poisson},
          .energetic = {impact.energetic, exact.energetic},
          .tangential = {impact.tangential, exact.tangential},
          .u = {impact.u1, exact.u1},
          .v = {impact.v1, exact.v1},
          .tau_compression = {impact.tau_compression, exact.tau_compression},
          .tau = {impact.tau1, exact.tau1},
          .f = {impact.f1, exact.f1},
          .work_normal_compression = {impact.work_normal_compression, exact.work_normal_compression},
          .work_normal_restitution = {impact.work_normal_restitution, exact.work_normal_restitution},
          .work_tangential_compression = {impact.work_tangential_compression, exact.work_tangential_compression},
          .work_tangential_restitution = {impact.work_tangential_restitution, exact.work_tangential_restitution},
          .energy_change = {impact.energy_change, exact.energy_change}};
}

struct NumberClaims {
  ClaimTally velocity, coefficient, impulse, work;

  void Add(const ImpactErrors& claimed, const ComparedNumbers& found, const std::string& scene) {
    const auto add = [&](ClaimTally& tally, const char* name, double error, const ComparedNumber& number) {
      if (std::isinf(error)) return tally.Add(error, 0.0);
      // Where a number or its claim is below the range of doubles, what is compared is the claim itself.
      const double size = number.size >= 0x1p-1000 ? number.size : error > 0.0 ? error : 1.0;
      tally.Add(error / size, number.reached / size, name + (" of " + scene));
    };
    add(velocity, "u", claimed.u, found.u);
    add(velocity, "v", claimed.v, found.v);
    add(coefficient, "newton", claimed.newton, found.newton);
    add(coefficient, "poisson", claimed.poisson, found.poisson);
    add(coefficient, "energetic", claimed.energetic, found.energetic);
    add(coefficient, "tangential", claimed.tangential, found.tangential);
    add(impulse, "tau_c", claimed.tau_compression, found.tau_compression);
    add(impulse, "tau", claimed.tau, found.tau);
    add(impulse, "f", claimed.f, found.f);
    add(work, "normal_c", claimed.work_normal_compression, found.work_normal_compression);
    add(work, "normal_r", claimed.work_normal_restitution, found.work_normal_restitution);
    add(work, "tangential_c", claimed.work_tangential_compression, found.work_tangential_compression);
    add(work, "tangential_r", claimed.work_tangential_restitution, found.work_tangential_restitution);
    add(work, "energy", claimed.energy_change, found.energy_change);
  }

  int broken() const { return velocity.broken() + coefficient.broken() + impulse.broken() + work.broken(); }
};

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_CLAIMS_NUMBER_CLAIMS_H_
