#include "core/models/finite_duration/motion.h"

#include <cassert>
#include <cmath>
#include <limits>
#include <variant>

#include "core/numerics/determinant.h"
#include "core/numerics/elementary.h"

namespace ricochet::finite_duration {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();

struct Curve {
  double stiffness = 0.0, exponent = 1.0, damping = 0.0;
  bool damped = false;
};

struct CurveOf {
  Curve operator()(std::monostate) const {
    assert(false);
    return {};
  }
  Curve operator()(const LinearSpring& spring) const { return {.stiffness = spring.stiffness_n_m}; }
  Curve operator()(const HertzSpring& spring) const { return {.stiffness = spring.stiffness_n_m1_5, .exponent = 1.5}; }
  Curve operator()(const HuntCrossleySpring& spring) const {
    return {spring.stiffness_n_m_p, spring.exponent, spring.damping_s_m, true};
  }
};

// k Wnn |v0|^(p-1) T^(p+1) = 1, root by root: no power leaves the range of doubles.
double NaturalTime(const Curve& curve, double wnn, double speed) {
  const double root = 1.0 / (curve.exponent + 1.0);
  return Pow(curve.stiffness, -root) * Pow(wnn, -root) * Pow(speed, -(curve.exponent - 1.0) * root);
}

void SetUnits(const Problem& problem, Contact& contact) {
  const Curve curve = std::visit(CurveOf(), problem.spring);
  contact.exponent = curve.exponent;
  contact.rooted = curve.exponent != 1.0;
  contact.damped = curve.damped;
  contact.speed = -problem.v0;
  contact.time = NaturalTime(curve, problem.wnn, contact.speed);
  const double turn = contact.speed / problem.normal_acceleration;
  if (turn > 0.0 && turn < contact.time) {
    contact.stiffness = Pow(turn / contact.time, curve.exponent + 1.0);
    contact.time = turn;
  }
  contact.mass = 1.0 / problem.wnn;
  contact.damping = curve.damping * contact.speed;
  const bool returns = Square(problem.energetic) >= std::numeric_limits<double>::min();
  contact.eta = curve.damped ? 1.0 : returns ? problem.energetic : 0.0;
}

// Of slip towards +t for mu > 0, towards -t for mu < 0.
Acceleration SlopeOf(const Problem& problem, double mu) {
  return {std::fma(-mu, problem.wtt, problem.wtn) / problem.wnn, std::fma(-mu, problem.wtn, problem.wnn) / problem.wnn};
}

void SetInertia(const Problem& problem, Contact& contact) {
  constexpr double kInRange = 8.0 * kEps;
  contact.wtn = problem.wtn / problem.wnn;
  contact.wtt = problem.wtt / problem.wnn;
  contact.forward_slope = SlopeOf(problem, problem.mu);
  contact.backward_slope = SlopeOf(problem, -problem.mu);
  contact.stick_slope = RelativeDeterminant(problem.wtt, problem.wtn, problem.wnn);
  if (RankOf(problem) == 2) return;
  contact.wtt = Square(contact.wtn);
  contact.stick_slope = 0.0;
  if (problem.wtn == 0.0) return;
  // u is then v Wtn/Wnn, unless a force of its own drives it off.
  const double in_range = contact.an * contact.wtn;
  contact.coupled = std::fabs(contact.at - in_range) <= kInRange * (std::fabs(contact.at) + std::fabs(in_range));
  contact.u0 = -contact.wtn;
  if (contact.coupled) contact.at = in_range;
}

bool HoldsFreely(const Problem& problem) {
  if (RankOf(problem) == 1) return std::fma(problem.mu_static, std::fabs(problem.wtn), -problem.wnn) >= 0.0;
  return std::fma(problem.mu_static, problem.wtt, -std::fabs(problem.wtn)) >= 0.0;
}

// K x^p, continued as an odd function below 0, where a step may try its way.
double LoadingCurve(const Contact& contact, double place) {
  if (!contact.rooted) return contact.stiffness * place;
  if (contact.exponent == 1.5) return contact.stiffness * (place * place * place);
  return contact.stiffness * std::copysign(Pow(std::fabs(place), 2.0 * contact.exponent), place);
}

double SpringSlope(const Contact& contact, const Mode& mode) {
  return mode.line == Line::kLoading ? 1.0 : 1.0 / Square(contact.eta);
}

// The speed of the particle that slides towards its grip, over the deflection's share of it.
double ParticleShare(const Contact& contact, const Mode& mode) {
  return contact.mu * contact.ratio_squared * SpringSlope(contact, mode);
}

Grip Towards(double direction) { return direction < 0.0 ? Grip::kBackward : Grip::kForward; }

// d/dt of the sliding particle's speed: what decides between sliding and sticking where that speed is 0.
double ParticleAcceleration(const Contact& contact, const Mode& mode, const Motion& y, double direction) {
  Mode sliding = mode;
  sliding.grip = Towards(direction);
  const double share = ParticleShare(contact, mode);
  const Forces forces = ForcesAt(contact, sliding, y);
  const Acceleration rate = AccelerationAt(contact, sliding, forces);
  const double pull = direction * rate.u + share * rate.v;
  if (forces.normal != 0.0 || pull != 0.0) return pull;
  const Acceleration& slope = direction < 0.0 ? contact.backward_slope : contact.forward_slope;
  return direction * slope.u + share * slope.v;
}

void SetRigidGuards(const Contact& contact, const Mode& mode, const Motion& y, const Forces& forces,
                    const Acceleration& rate, Guards& guards) {
  if (mode.grip == Grip::kStick) {
    // Without a finite force along t the cone is left nowhere.
    if (contact.at == 0.0) return;
    const double hold = contact.mu_static * contact.wtt * forces.normal;
    const double drive = contact.wtn * forces.normal + contact.at;
    guards[kUpper] = hold - drive;
    guards[kLower] = hold + drive;
  } else if (!contact.coupled) {
    const double sign = SlipSign(mode.grip);
    guards[kUpper] = sign * y[kU];
    if (contact.at != 0.0) guards[kUpperExtreme] = sign * rate.u;
  }
}

void SetCompliantGuards(const Contact& contact, const Mode& mode, const Motion& y, const Forces& forces,
                        const Acceleration& rate, Guards& guards) {
  const double share = ParticleShare(contact, mode);
  if (mode.grip == Grip::kStick) {
    const double cone = contact.mu * forces.normal;
    guards[kUpper] = cone - forces.tangential;
    guards[kLower] = cone + forces.tangential;
    guards[kUpperExtreme] = y[kU] - share * y[kV];
    guards[kLowerExtreme] = y[kU] + share * y[kV];
    guards[kForceExtreme] = y[kU];
  } else {
    const double sign = SlipSign(mode.grip);
    guards[kUpper] = sign * y[kU] + share * y[kV];
    guards[kUpperExtreme] = sign * rate.u + share * rate.v;
  }
}

Grip CompliantGripAfter(const Contact& contact, const Mode& mode, const Motion& y, Guard fallen) {
  if (mode.grip != Grip::kStick) {
    return ParticleAcceleration(contact, mode, y, SlipSign(mode.grip)) < 0.0 ? Grip::kStick : mode.grip;
  }
  // The upper side is that of F > 0, which acts on a particle that slides backwards.
  const double direction = fallen == kUpper ? -1.0 : 1.0;
  const double speed = direction * y[kU] + ParticleShare(contact, mode) * y[kV];
  const bool slides = speed > 0.0 || (speed == 0.0 && ParticleAcceleration(contact, mode, y, direction) >= 0.0);
  return slides ? Towards(direction) : mode.grip;
}

}  // namespace

int RankOf(const Problem& problem) {
  constexpr double kRankOne = 4.0 * kEps;
  return std::fabs(RelativeDeterminant(problem.wtt, problem.wtn, problem.wnn)) <= kRankOne ? 1 : 2;
}

Contact MakeContact(const Problem& problem) {
  Contact contact;
  SetUnits(problem, contact);
  contact.u0 = problem.u0 / contact.speed;
  contact.at = problem.tangential_acceleration * contact.time / contact.speed;
  contact.an = problem.normal_acceleration * contact.time / contact.speed;
  contact.mu = problem.mu;
  contact.mu_static = problem.mu_static;
  contact.compliant = problem.ratio_squared.has_value();
  contact.ratio_squared = problem.ratio_squared.value_or(0.0);
  SetInertia(problem, contact);
  contact.smooth = problem.mu_static == 0.0 || contact.wtt == 0.0;
  contact.holds_freely = HoldsFreely(problem);
  return contact;
}

double SlipSign(Grip grip) { return grip == Grip::kForward ? 1.0 : grip == Grip::kBackward ? -1.0 : 0.0; }

double Pace(const Contact& contact, const Mode& mode) { return mode.line == Line::kLoading ? 1.0 : contact.eta; }

double Indentation(const Contact& contact, const Mode& mode, const Motion& y) {
  const double x = contact.rooted ? Square(y[kPlace]) : y[kPlace];
  if (mode.line == Line::kLoading) return x;
  const double largest = contact.rooted ? Square(mode.largest) : mode.largest;
  return largest - Square(contact.eta) * (largest - x);
}

Forces ForcesAt(const Contact& contact, const Mode& mode, const Motion& y) {
  const double normal = LoadingCurve(contact, y[kPlace]) * (1.0 - contact.damping * y[kV]);
  switch (mode.grip) {
    case Grip::kNone:
      return {normal, 0.0};
    case Grip::kForward:
      return {normal, -contact.mu * normal};
    case Grip::kBackward:
      return {normal, contact.mu * normal};
    case Grip::kStick:
      break;
  }
  if (contact.compliant) return {normal, y[kSpringForce]};
  return {normal, -(contact.wtn * normal + contact.at) / contact.wtt};
}

Acceleration AccelerationAt(const Contact& contact, const Mode& mode, const Forces& forces) {
  const bool held = mode.grip == Grip::kStick && !contact.compliant;
  if (held && contact.coupled) return {};
  if (held) {
    return {0.0, contact.stick_slope * forces.normal + (contact.an - contact.at * contact.wtn / contact.wtt)};
  }
  Acceleration rate = {contact.at, contact.an};
  if (mode.grip == Grip::kForward || mode.grip == Grip::kBackward) {
    const Acceleration& slope = mode.grip == Grip::kForward ? contact.forward_slope : contact.backward_slope;
    rate.u += slope.u * forces.normal;
    rate.v += slope.v * forces.normal;
  } else {
    rate.u += contact.wtt * forces.tangential + contact.wtn * forces.normal;
    rate.v += contact.wtn * forces.tangential + forces.normal;
  }
  if (contact.coupled) rate.u = contact.wtn * rate.v;
  return rate;
}

Motion RatesAt(const Contact& contact, const Mode& mode, const Motion& y) {
  const Forces forces = ForcesAt(contact, mode, y);
  const Acceleration acceleration = AccelerationAt(contact, mode, forces);
  const double pace = Pace(contact, mode);
  const double dt = contact.rooted ? 2.0 * y[kPlace] * pace : pace;
  const bool particle_sticks = contact.compliant && mode.grip == Grip::kStick;
  const double sign = SlipSign(mode.grip);
  const bool particle_slides = contact.compliant && sign != 0.0;
  const double slip = sign * y[kU] + (particle_slides ? ParticleShare(contact, mode) * y[kV] : 0.0);
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
  rates[kDampingLoss] = LoadingCurve(contact, y[kPlace]) * contact.damping * Square(y[kV]) * dt;
  return rates;
}

Guards GuardsAt(const Contact& contact, const Mode& mode, const Motion& y) {
  Guards guards;
  guards.fill(1.0);
  const Forces forces = ForcesAt(contact, mode, y);
  const Acceleration rate = AccelerationAt(contact, mode, forces);
  guards[kTurn] = mode.line == Line::kUnloading ? y[kV] : -y[kV];
  // Without finite forces they are N times a constant, whose sign rounding may lose.
  const bool may_return = contact.at != 0.0 || contact.an != 0.0 || contact.compliant;
  if (may_return) guards[kTurnExtreme] = rate.v;
  if (mode.line == Line::kUnloading) guards[kLineEnd] = y[kPlace];
  if (mode.line == Line::kReloading) guards[kLineEnd] = mode.largest - y[kPlace];
  if (contact.damped) {
    // N' over x^(p-1).
    const double x = contact.rooted ? Square(y[kPlace]) : y[kPlace];
    const double stretch = 1.0 - contact.damping * y[kV];
    guards[kForceExtreme] = -contact.exponent * y[kV] * stretch - x * contact.damping * rate.v;
    if (mode.line == Line::kUnloading) guards[kTension] = stretch;
  }
  if (mode.grip == Grip::kNone) return guards;
  if (contact.compliant) {
    SetCompliantGuards(contact, mode, y, forces, rate, guards);
  } else {
    SetRigidGuards(contact, mode, y, forces, rate, guards);
  }
  return guards;
}

bool NeverTurns(const Contact& contact, const Mode& mode, const Motion& y) {
  if (mode.grip != Grip::kStick || contact.compliant || contact.stick_slope != 0.0 || y[kV] >= 0.0) return false;
  // The cone, which is a line in N, holds here and at infinity.
  const Forces forces = ForcesAt(contact, mode, y);
  return contact.holds_freely && AccelerationAt(contact, mode, forces).v <= 0.0;
}

Motion StartOf(const Contact& contact) {
  Motion y = {};
  y[kU] = contact.u0;
  y[kV] = -1.0;
  return y;
}

Grip GripAtRest(const Contact& contact, double normal) {
  if (contact.smooth) return Grip::kNone;
  // As nothing else pulls, the comparison is the same at every N, and the one that rounding cannot reach.
  if (contact.at == 0.0) return contact.holds_freely ? Grip::kStick : Towards(contact.wtn);
  const double drive = contact.wtn * normal + contact.at;
  return std::fabs(drive) <= contact.mu_static * contact.wtt * normal ? Grip::kStick : Towards(drive);
}

Grip GripAtStart(const Contact& contact) {
  if (contact.smooth) return Grip::kNone;
  if (!contact.compliant) return contact.u0 == 0.0 ? GripAtRest(contact, 0.0) : Towards(contact.u0);
  const double speed = std::fabs(contact.u0) - contact.mu * contact.ratio_squared;
  const double direction = contact.u0 < 0.0 ? -1.0 : 1.0;
  const bool slides =
      speed > 0.0 || (speed == 0.0 && ParticleAcceleration(contact, {}, StartOf(contact), direction) >= 0.0);
  return slides ? Towards(direction) : Grip::kStick;
}

Grip GripAfter(const Contact& contact, const Mode& mode, const Motion& y, Guard fallen) {
  if (contact.compliant) return CompliantGripAfter(contact, mode, y, fallen);
  if (mode.grip == Grip::kStick) return fallen == kUpper ? Grip::kForward : Grip::kBackward;
  return GripAtRest(contact, ForcesAt(contact, mode, y).normal);
}

}  // namespace ricochet::finite_duration
