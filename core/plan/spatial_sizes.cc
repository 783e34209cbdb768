#include <algorithm>
#include <array>
#include <cmath>

#include "core/models/restitution_law.h"
#include "core/plan/perturbed_path.h"
#include "core/plan/sizes.h"

namespace ricochet {
namespace {

constexpr double kRounding = 0x1p-46;

// A contact in space in the scales of core/plan/perturbed_path.h; slip starts along e0. Comments give the symbols of
// docs/theory/plan.md, section 4.
struct Scaled {
  double w11, w12, w22;  // Wtt/Wnn
  double w13, w23;       // wtn/Wnn
  double lambda_low, lambda_high;
  Mobility mobility;
  double slip = 0.0;  // |u0|
  double mu = 0.0;
  double mu_static = 0.0;
  double holding = 0.0;  // |Wtt^-1 wtn|; infinite if Wtt is singular
  Restoring restoring;
  double along_normal = 0.0;  // wtn.e0
  double slowing = 0.0;       // -h(phi0)
  double turning = 0.0;       // |g(phi0)|
  double u_slope = 0.0;       // |u'| of A

  double Terms() const { return mu * lambda_high + mobility.coupling; }
  double Lipschitz() const { return mu * (lambda_high - lambda_low) + mobility.coupling; }
  double SlideSlope() const { return 1.0 - mu * along_normal; }
  double Friction() const { return holding <= mu_static * (1.0 + kRounding) ? std::max(mu, holding) : mu; }
  double Change(const ReferencePath& reference, const Perturbation& change) const {
    return WithRoundingMargin(LargestChange(mobility, restoring, reference, change));
  }
};

void SetEigenvalues(Scaled& contact) {
  const double mean = 0.5 * (contact.w11 + contact.w22);
  const double half = 0.5 * (contact.w11 - contact.w22);
  const double radius = std::sqrt(half * half + contact.w12 * contact.w12);
  contact.lambda_high = (mean + radius) * (1.0 + kRounding);
  contact.lambda_low = std::max(mean - radius - kRounding * mean, 0.0);
  const double determinant = contact.lambda_low * contact.lambda_high;
  const double h1 = (contact.w22 * contact.w13 - contact.w12 * contact.w23) / determinant;
  const double h2 = (contact.w11 * contact.w23 - contact.w12 * contact.w13) / determinant;
  const double size = std::sqrt(h1 * h1 + h2 * h2) * (1.0 + 0x1p-20);
  // If Wtt is within 2^-20 of singular, rounding could hide the force of stick.
  contact.holding = contact.lambda_low > 0x1p-20 * contact.lambda_high ? size : kUnbounded;
  if (contact.mobility.coupling == 0.0) contact.holding = 0.0;
}

void SetDirection(const std::array<double, 2>& u0, Scaled& contact) {
  const double size = std::sqrt(u0[0] * u0[0] + u0[1] * u0[1]);
  if (size == 0.0) return;
  const double e1 = u0[0] / size;
  const double e2 = u0[1] / size;
  const double u1 = contact.w13 - contact.mu * (contact.w11 * e1 + contact.w12 * e2);
  const double u2 = contact.w23 - contact.mu * (contact.w12 * e1 + contact.w22 * e2);
  contact.along_normal = contact.w13 * e1 + contact.w23 * e2;
  contact.slowing = -(u1 * e1 + u2 * e2) + kRounding * contact.Terms();
  contact.turning = std::fabs(u2 * e1 - u1 * e2) + kRounding * contact.Terms();
  contact.u_slope = std::sqrt(u1 * u1 + u2 * u2) + kRounding * contact.Terms();
}

Scaled Scale(const spatial::Problem& problem) {
  Scaled contact;
  const double n = problem.w33;
  const double speed = -problem.v0;
  contact.w11 = problem.w11 / n;
  contact.w12 = problem.w12 / n;
  contact.w22 = problem.w22 / n;
  contact.w13 = problem.w13 / n;
  contact.w23 = problem.w23 / n;
  const double coupling = std::sqrt(contact.w13 * contact.w13 + contact.w23 * contact.w23);
  contact.mobility = {.tangential = contact.w11 + contact.w22, .coupling = coupling};
  contact.mu = problem.mu;
  contact.mu_static = problem.mu_static;
  SetEigenvalues(contact);
  const double slip = std::sqrt(problem.u0[0] * problem.u0[0] + problem.u0[1] * problem.u0[1]);
  contact.slip = slip / speed;
  contact.restoring = {.law = problem.law, .coefficient = problem.coefficient};
  SetDirection(problem.u0, contact);
  return contact;
}

// The largest normal impulse of an impact with v' in [low, high].
double LongestImpulse(const Restoring& restoring, double low, double high) {
  const double c = restoring.coefficient;
  const double v1 = restoring.law == RestitutionLaw::kEnergetic ? c * std::sqrt(high / low) : c;
  return (1.0 + v1) / low;
}

struct Turn {
  double angle = kUnbounded;
  double least_slip = 0.0;
};

// Returns the bounds that follow from the assumption |phi - phi0| <= angle.
Turn Supposing(const Scaled& contact, double angle) {
  const double spread = contact.mu * contact.mobility.coupling * std::min(angle, 2.0);
  const double low = contact.SlideSlope() - spread;
  if (!(low >= kLeastSlope)) return {};
  const double impulse = LongestImpulse(contact.restoring, low, contact.SlideSlope() + spread) * (1.0 + 0x1p-20);
  const double lipschitz = contact.Lipschitz();
  const double slowing = contact.slowing + lipschitz * angle;
  const double end = contact.slip - slowing * impulse;
  if (!(end > kRounding * contact.slip)) return {};
  const double passed = 0.5 * impulse * (1.0 / contact.slip + 1.0 / end);
  const double left = 1.0 - 0.5 * lipschitz * passed;
  if (!(left > 0.0)) return {};
  return {.angle = contact.turning * passed / left * (1.0 + 0x1p-20), .least_slip = std::min(contact.slip, end)};
}

// Tries a few angles and returns the bounds for the smallest one that confirms its own assumption. If nothing follows
// from an angle, nothing follows from a larger one.
Turn LargestTurn(const Scaled& contact) {
  if (!(contact.slip > 0.0)) return {};
  double angle = 1.5 * contact.turning / (contact.slip * contact.SlideSlope());
  for (int i = 0; i < 8; ++i, angle *= 2.0) {
    const Turn turn = Supposing(contact, angle);
    if (turn.angle < angle) return turn;
    if (turn.angle == kUnbounded) break;
  }
  return {};
}

Size Locking(double cone) { return {.value = kUnbounded, .basis = Basis::kSelfLocking, .number = cone}; }

Size FrictionSize(const Scaled& contact) {
  const double m = contact.Friction();
  if (m == 0.0) return {};
  const double cone = m * contact.mobility.coupling;
  const double size = contact.Change({.u_slope = contact.mobility.coupling},
                                     {.f_slope = m, .slope_low = 1.0 - cone, .slope_high = 1.0 + cone});
  if (!(size < kUnbounded)) return Locking(cone);
  return {.value = size, .basis = Basis::kInequality, .number = cone};
}

ReferencePath Sliding(const Scaled& contact) {
  return {.slope_low = contact.SlideSlope(),
          .slope_high = contact.SlideSlope(),
          .u_slope = contact.u_slope,
          .f_slope = contact.mu};
}

// Sets the sizes of slip for an isotropic contact such as a sphere's: slip keeps its direction until it stops and
// sticks.
void SetStraight(const Scaled& contact, double speed, Sizes& sizes) {
  sizes[Effect::kSlipTurn] = {.basis = Basis::kStraight};
  Size& stop = sizes[Effect::kSlipStop];
  if (contact.slip == 0.0) {
    stop = {.value = kUnbounded, .basis = Basis::kStaysAtRest};
    return;
  }
  const double impulse = 1.0 + contact.restoring.coefficient;
  const double end = contact.slip - contact.slowing * impulse;
  if (end > kRounding * contact.slip) {
    stop = {.value = 0.0, .basis = Basis::kSlidesThroughout, .number = speed * end};
    return;
  }
  const double from = contact.slip / contact.slowing * (1.0 - kRounding);
  stop = {.value = contact.Change(Sliding(contact),
                                  {.f_slope = contact.mu, .from = from, .slope_low = 1.0, .slope_high = 1.0}),
          .basis = Basis::kInequality,
          .number = std::min(1.0, from / impulse)};
}

void SetSlip(const Scaled& contact, double speed, Sizes& sizes) {
  if (contact.Friction() == 0.0) return;
  const bool isotropic = contact.w12 == 0.0 && contact.w11 == contact.w22 && contact.mobility.coupling == 0.0;
  if (isotropic) {
    SetStraight(contact, speed, sizes);
    return;
  }
  sizes[Effect::kSlipTurn] = {.value = kUnbounded, .basis = Basis::kNoInequality};
  sizes[Effect::kSlipStop] = {.value = kUnbounded, .basis = Basis::kNoInequality};
  const Turn turn = LargestTurn(contact);
  if (!(turn.angle < kUnbounded)) return;
  const double chord = contact.mu * std::min(turn.angle, 2.0);
  const double spread = chord * contact.mobility.coupling;
  const double size = contact.Change(
      Sliding(contact),
      {.f_slope = chord, .slope_low = contact.SlideSlope() - spread, .slope_high = contact.SlideSlope() + spread});
  if (!(size < kUnbounded)) return;
  sizes[Effect::kSlipTurn] = {.value = size, .basis = Basis::kInequality, .number = turn.angle};
  sizes[Effect::kSlipStop] = {.value = 0.0, .basis = Basis::kSlidesThroughout, .number = speed * turn.least_slip};
}

Size StaticSize(const Scaled& contact, double speed, const Size& stop) {
  if (!(contact.mu_static > contact.mu)) return {};
  const bool disagree = contact.holding == kUnbounded || (contact.holding >= contact.mu * (1.0 - 0x1p-19) &&
                                                          contact.holding <= contact.mu_static * (1.0 + 0x1p-19));
  if (!disagree || contact.mobility.coupling == 0.0) return {.basis = Basis::kDecidesNothing};
  if (contact.slip > 0.0 && stop.basis == Basis::kSlidesThroughout) return stop;
  const double cone = contact.Friction() * contact.mobility.coupling;
  if (!(1.0 - cone >= kLeastSlope)) return Locking(cone);
  const double impulse = LongestImpulse(contact.restoring, 1.0 - cone, 1.0 + cone);
  const double from = contact.slip / contact.Terms() * (1.0 - kRounding);
  if (from > impulse * (1.0 + 0x1p-20)) {
    return {
        .value = 0.0, .basis = Basis::kSlidesThroughout, .number = speed * (contact.slip - contact.Terms() * impulse)};
  }
  const ReferencePath any = {.slope_low = 1.0 - cone,
                             .slope_high = 1.0 + cone,
                             .u_slope = contact.mobility.coupling + contact.Friction() * contact.lambda_high,
                             .f_slope = contact.Friction()};
  const double size = contact.Change(
      any, {.f_slope = contact.mu + contact.holding, .from = from, .slope_low = 1.0 - cone, .slope_high = 1.0 + cone});
  if (!(size < kUnbounded)) return Locking(cone);
  return {.value = size, .basis = Basis::kInequality, .number = std::min(1.0, from / impulse)};
}

}  // namespace

Sizes SpatialSizes(const spatial::Problem& problem) {
  Sizes sizes;
  const Scaled contact = Scale(problem);
  sizes[Effect::kFriction] = FrictionSize(contact);
  const bool is_immobile = problem.w11 == 0.0 && problem.w22 == 0.0;
  // Where tangential impulses move nothing, a contact that slips still receives a friction impulse that does work.
  if (is_immobile && contact.slip > 0.0 && problem.mu > 0.0) {
    sizes[Effect::kFriction] = {.value = kUnbounded, .basis = Basis::kNoInequality};
  }
  SetSlip(contact, -problem.v0, sizes);
  sizes[Effect::kStaticFriction] = StaticSize(contact, -problem.v0, sizes[Effect::kSlipStop]);
  sizes[Effect::kHigherOrder].basis = Basis::kNotOfSystem;
  return sizes;
}

}  // namespace ricochet
