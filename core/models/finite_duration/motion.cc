#include "core/models/finite_duration/motion.h"

#include <cmath>

#include "core/numerics/elementary.h"

namespace ricochet::finite_duration {
namespace {

double SpringSlope(const ScaledContact& contact, const Mode& mode) {
  return mode.branch == LoadingBranch::kLoading ? 1.0 : 1.0 / Square(contact.eta);
}

}  // namespace

double SlipSign(FrictionState friction) {
  return friction == FrictionState::kSlipForward ? 1.0 : friction == FrictionState::kSlipBackward ? -1.0 : 0.0;
}

FrictionState SlipTowards(double direction) {
  return direction < 0.0 ? FrictionState::kSlipBackward : FrictionState::kSlipForward;
}

// K x^p, continued as an odd function below 0, which a trial step may reach.
double LoadingCurve(const ScaledContact& contact, double place) {
  if (!contact.rooted) return contact.stiffness * place;
  if (contact.exponent == 1.5) return contact.stiffness * (place * place * place);
  return contact.stiffness * std::copysign(Pow(std::fabs(place), 2.0 * contact.exponent), place);
}

double ParticleSpeed(const ScaledContact& contact, const Mode& mode, double direction, double u, double v) {
  const double share = contact.mu * contact.ratio_squared * SpringSlope(contact, mode);
  // Where u follows v, the particle's speed is a multiple of v: it must not vanish a rounding before or after v does.
  if (contact.coupled) return (direction * contact.wtn + share) * v;
  return direction * u + share * v;
}

double Stretch(const ScaledContact& contact, const Motion& y) {
  return contact.pulled ? y[kStretch] : 1.0 - contact.damping * y[kV];
}

Motion MotionAtStart(const ScaledContact& contact) {
  Motion y = {};
  y[kU] = contact.u0;
  y[kV] = -1.0;
  y[kStretch] = 1.0 + contact.damping;
  return y;
}

double Pace(const ScaledContact& contact, const Mode& mode) {
  return mode.branch == LoadingBranch::kLoading ? 1.0 : contact.eta;
}

double Indentation(const ScaledContact& contact, const Mode& mode, const Motion& y) {
  const double x = contact.rooted ? Square(y[kPlace]) : y[kPlace];
  if (mode.branch == LoadingBranch::kLoading) return x;
  const double largest = contact.rooted ? Square(mode.largest_place) : mode.largest_place;
  return largest - Square(contact.eta) * (largest - x);
}

Forces ForcesAt(const ScaledContact& contact, const Mode& mode, const Motion& y) {
  const double normal = LoadingCurve(contact, y[kPlace]) * Stretch(contact, y);
  switch (mode.friction) {
    case FrictionState::kNone:
      return {normal, 0.0};
    case FrictionState::kSlipForward:
      return {normal, -contact.mu * normal};
    case FrictionState::kSlipBackward:
      return {normal, contact.mu * normal};
    case FrictionState::kStick:
      break;
  }
  if (contact.compliant) return {normal, y[kSpringForce]};
  return {normal, -(contact.wtn * normal + contact.at) / contact.wtt};
}

Acceleration AccelerationAt(const ScaledContact& contact, const Mode& mode, const Forces& forces) {
  const bool held = mode.Sticks() && !contact.compliant;
  if (held && contact.coupled) return {};
  if (held) {
    return {0.0, contact.stick_slope * forces.normal + (contact.an - contact.at * contact.wtn / contact.wtt)};
  }
  Acceleration rate = {contact.at, contact.an};
  if (const double sign = SlipSign(mode.friction); sign != 0.0) {
    const Acceleration& slope = contact.SlipSlope(sign);
    rate.u += slope.u * forces.normal;
    rate.v += slope.v * forces.normal;
  } else {
    rate.u += contact.wtt * forces.tangential + contact.wtn * forces.normal;
    rate.v += contact.wtn * forces.tangential + forces.normal;
  }
  if (contact.coupled) rate.u = contact.wtn * rate.v;
  return rate;
}

Motion RatesAt(const ScaledContact& contact, const Mode& mode, const Motion& y) {
  const Forces forces = ForcesAt(contact, mode, y);
  const Acceleration acceleration = AccelerationAt(contact, mode, forces);
  const double pace = Pace(contact, mode);
  const double dt = contact.rooted ? 2.0 * y[kPlace] * pace : pace;
  const bool particle_sticks = contact.compliant && mode.Sticks();
  const double sign = SlipSign(mode.friction);
  const bool particle_slides = contact.compliant && sign != 0.0;
  const double slip = particle_slides ? ParticleSpeed(contact, mode, sign, y[kU], y[kV]) : sign * y[kU];
  Motion rates;
  rates[kPlace] = -y[kV] / pace;
  rates[kU] = acceleration.u * dt;
  rates[kV] = acceleration.v * dt;
  rates[kSpringForce] = particle_sticks ? -contact.stiffness * y[kU] / contact.ratio_squared * dt : 0.0;
  rates[kTime] = dt;
  rates[kNormal] = forces.normal * dt;
  rates[kTangential] = forces.tangential * dt;
  rates[kNormalMoment] = y[kNormal] * dt;
  rates[kTangentMoment] = y[kTangential] * dt;
  rates[kNormalWork] = forces.normal * y[kV] * dt;
  rates[kTangentWork] = forces.tangential * y[kU] * dt;
  rates[kFrictionLoss] = contact.mu * forces.normal * slip * dt;
  rates[kStretch] = -contact.damping * rates[kV];
  rates[kDampingLoss] = LoadingCurve(contact, y[kPlace]) * contact.damping * Square(y[kV]) * dt;
  return rates;
}

}  // namespace ricochet::finite_duration
