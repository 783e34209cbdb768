// Chatterjee and Ruina's law: a weighted sum of two plastic impulses, kept inside the friction cone.
//
// A. Chatterjee and A. Ruina, J. Appl. Mech. 65 (1998) 939-951. P_I is the frictionless impulse that ends the approach,
// P_II = -W^-1 (u0, v0) the one that ends approach and slip:
//
//   P = (1 + e) P_I + k (P_II - P_I),   k = 1 + e_t, or the smaller k that puts P on the cone |P_t| = mu P_n
//
// e_t, from -1 (frictionless) to 1, is a coefficient of tangential restitution: 1 reverses the slip of a sphere. For
// 0 <= e <= 1 the law creates no energy. At rank one, P_II is the impulse of minimum norm: velocities do not depend on
// that choice, impulses do. docs/theory/laws.md has the proof and the formulas in coordinates.

#include <cmath>
#include <limits>
#include <utility>

#include "core/models/laws/impact_law.h"
#include "core/models/laws/impact_law_parts.h"

namespace ricochet::laws {
namespace {

// The tangential part of P_II - P_I. The normal part is -wtn/wnn times the tangential one. At rank one and beside the
// range of W no impulse ends approach and slip: the part is without limit as det W vanishes.
double StickingImpulse(const PlanarProblem& in, const NewtonImpact& impact) {
  const double slip = impact.frictionless_slip();
  if (impact.rank_one() && slip != 0.0) return std::copysign(std::numeric_limits<double>::infinity(), -slip);
  if (impact.rank_one()) return -in.v0 * (in.w.tn / in.w.nn) / (in.w.tt + in.w.nn);
  return -impact.frictionless_slip() / impact.det();
}

}  // namespace

ImpactLawResult SolveChatterjeeRuina(const PlanarProblem& input, double e, double e_t) {
  const NewtonImpact impact(input, e);
  if (auto trivial = impact.Trivial()) return *std::move(trivial);

  const double f = e_t == -1.0 ? 0.0 : (1.0 + e_t) * StickingImpulse(input, impact);
  const double on_cone = input.mu * Sign(f);
  if (std::isinf(f) || std::abs(f) * impact.NormalSlope(on_cone) > input.mu * impact.normal_change()) {
    return AtMostOne(impact.AtRatio(on_cone));
  }
  const double tau1 = std::fma(-f, input.w.tn, impact.normal_change()) / input.w.nn;
  // -(e_t (u0 wnn - v0 wtn) + e v0 wtn), of which nothing cancels for e = e_t.
  const double slip = impact.rank_one() ? impact.tangential_numerator()
                                        : -std::fma(e_t * input.u0, input.w.nn, (e - e_t) * input.v0 * input.w.tn);
  return AtMostOne(impact.Solution(f, tau1, slip / input.w.nn));
}

}  // namespace ricochet::laws
