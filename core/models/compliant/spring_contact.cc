#include "core/models/compliant/spring_contact.h"

#include <cmath>

#include "core/numerics/products.h"

namespace ricochet::compliant {

bool ContactState::IsFinite() const { return std::isfinite(normal_force + spring_force + u + v + tau + f); }

SpringContact MakeSpringContact(const PlanarProblem& problem, double ratio_squared) {
  const auto& [wtt, wtn, wnn] = problem.w;
  SpringContact contact = {.wtt = wtt,
                           .wtn = wtn,
                           .wnn = wnn,
                           .rank = problem.w.Rank(),
                           .mu = problem.mu,
                           .ratio_squared = ratio_squared,
                           .eta = problem.coefficient < kLeastEnergetic ? 0.0 : problem.coefficient};
  if (contact.rank == 2) {
    contact.determinant = DifferenceOfProducts(wtt, wnn, wtn, wtn);
  } else if (wtt > 0.0) {
    contact.u_follows_v = problem.w.UFollowsV(problem.u0, problem.v0);
    contact.wtt = wtn / wnn * wtn;
  }
  return contact;
}

double SpringContact::NormalSlope(int side) const { return std::fma(-side * mu, wtn, wnn); }

double SpringContact::SlipSlope(LoadingBranch branch, int side) const {
  const double compliance = mu * ratio_squared * NormalStiffness(branch);
  const double normal_slope = NormalSlope(side);
  if (u_follows_v) {
    const double slope = side * wtn / wnn;
    const double sum = slope + compliance;
    return std::fabs(sum) <= 4.0 * kEps * compliance ? 0.0 : normal_slope * sum;
  }
  const double sum = side * wtn - mu * wtt + compliance * normal_slope;
  const double size = std::fabs(wtn) + mu * wtt + compliance * std::fabs(normal_slope);
  return std::fabs(sum) <= 4.0 * kEps * size ? 0.0 : sum;
}

double SpringContact::SlipSpeed(LoadingBranch branch, int side, const ContactState& state) const {
  const double compliance = mu * ratio_squared * NormalStiffness(branch);
  if (u_follows_v) return state.v * (side * wtn / wnn + compliance);
  return side * state.u + compliance * state.v;
}

double SpringContact::SlipSpeedAtStart(int side, const ContactState& state) const {
  if (u_follows_v) return SlipSpeed(LoadingBranch::kFirstLoading, side, state);
  // The two terms may cancel: their difference is exact then, and the rounding of the product of three is added.
  const double compliance = mu * ratio_squared;
  const double product = compliance * state.v;
  const double lost = std::fma(compliance, state.v, -product) + std::fma(mu, ratio_squared, -compliance) * state.v;
  return (side * state.u + product) + lost;
}

}  // namespace ricochet::compliant
