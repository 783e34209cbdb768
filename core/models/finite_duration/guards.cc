#include "core/models/finite_duration/guards.h"

#include <cmath>

namespace ricochet::finite_duration {
namespace {

void SetRigidGuards(const ScaledContact& contact, const Mode& mode, const Motion& y, const Forces& forces,
                    Guards& guards) {
  if (mode.Sticks()) {
    // The cone is left nowhere unless a finite force acts along t.
    if (contact.at == 0.0) return;
    const double hold = contact.mu_static * contact.wtt * forces.normal;
    const double drive = contact.wtn * forces.normal + contact.at;
    guards[kUpper] = hold - drive;
    guards[kLower] = hold + drive;
  } else if (!contact.coupled) {
    guards[kUpper] = SlipSign(mode.friction) * y[kU];
  }
}

void SetCompliantGuards(const ScaledContact& contact, const Mode& mode, const Motion& y, const Forces& forces,
                        Guards& guards) {
  if (mode.Sticks()) {
    const double cone = contact.mu * forces.normal;
    guards[kUpper] = cone - forces.tangential;
    guards[kLower] = cone + forces.tangential;
    guards[kForceExtreme] = y[kU];
  } else {
    guards[kUpper] = ParticleSpeed(contact, mode, SlipSign(mode.friction), y[kU], y[kV]);
  }
}

// True if v would rise where N = 0. Otherwise N only comes close to 0 before the end of restitution, the closer the
// stronger the damping is, and that it falls below 0 is rounding.
bool IsPulledApart(const ScaledContact& contact, const Mode& mode, const Motion& y) {
  Forces forces = ForcesAt(contact, mode, y);
  if (!(mode.Sticks() && contact.compliant)) forces.tangential = 0.0;
  forces.normal = 0.0;
  return AccelerationAt(contact, mode, forces).v > 0.0;
}

// d/dt of the sliding particle's speed decides between sliding and sticking where that speed is 0.
double ParticleAcceleration(const ScaledContact& contact, const Mode& mode, const Motion& y, double direction) {
  Mode sliding = mode;
  sliding.friction = SlipTowards(direction);
  const Forces forces = ForcesAt(contact, sliding, y);
  const Acceleration rate = AccelerationAt(contact, sliding, forces);
  const double pull = ParticleSpeed(contact, mode, direction, rate.u, rate.v);
  if (forces.normal != 0.0 || pull != 0.0) return pull;
  const Acceleration& slope = contact.SlipSlope(direction);
  return ParticleSpeed(contact, mode, direction, slope.u, slope.v);
}

// True if the particle slides towards `direction`: its speed towards it is positive, or 0 and does not fall.
bool ParticleSlides(const ScaledContact& contact, const Mode& mode, const Motion& y, double direction) {
  const double speed = ParticleSpeed(contact, mode, direction, y[kU], y[kV]);
  return speed > 0.0 || (speed == 0.0 && ParticleAcceleration(contact, mode, y, direction) >= 0.0);
}

FrictionState CompliantFrictionAfter(const ScaledContact& contact, const Mode& mode, const Motion& y, Guard fallen) {
  if (!mode.Sticks()) {
    return ParticleAcceleration(contact, mode, y, SlipSign(mode.friction)) < 0.0 ? FrictionState::kStick
                                                                                 : mode.friction;
  }
  // A spring that is not stretched cannot overcome friction: the guard fell by rounding where N is next to nothing.
  if (ForcesAt(contact, mode, y).tangential == 0.0) return mode.friction;
  // The upper side is that of F > 0, which acts on a particle that slides backwards.
  const double direction = fallen == kUpper ? -1.0 : 1.0;
  return ParticleSlides(contact, mode, y, direction) ? SlipTowards(direction) : mode.friction;
}

}  // namespace

Guards GuardsAt(const ScaledContact& contact, const Mode& mode, const Motion& y) {
  Guards guards;
  guards.fill(1.0);
  const Forces forces = ForcesAt(contact, mode, y);
  guards[kReversal] = mode.Unloads() ? y[kV] : -y[kV];
  if (mode.Unloads()) guards[kBranchEnd] = y[kPlace];
  if (mode.branch == LoadingBranch::kReloading) guards[kBranchEnd] = mode.largest_place - y[kPlace];
  if (contact.damped) {
    // The guard of the extreme force is N' over x^(p-1).
    const double x = contact.rooted ? Square(y[kPlace]) : y[kPlace];
    const double stretch = Stretch(contact, y);
    guards[kForceExtreme] =
        -contact.exponent * y[kV] * stretch - x * contact.damping * AccelerationAt(contact, mode, forces).v;
    if (mode.Unloads() && IsPulledApart(contact, mode, y)) guards[kTension] = stretch;
  }
  if (mode.friction == FrictionState::kNone) return guards;
  if (contact.compliant) {
    SetCompliantGuards(contact, mode, y, forces, guards);
  } else {
    SetRigidGuards(contact, mode, y, forces, guards);
  }
  return guards;
}

FrictionState FrictionAtRest(const ScaledContact& contact, double normal) {
  if (contact.smooth) return FrictionState::kNone;
  // Without a finite tangential force the comparison is the same for every N, and holds_freely has no rounding.
  if (contact.at == 0.0) return contact.holds_freely ? FrictionState::kStick : SlipTowards(contact.wtn);
  const double drive = contact.wtn * normal + contact.at;
  return std::fabs(drive) <= contact.mu_static * contact.wtt * normal ? FrictionState::kStick : SlipTowards(drive);
}

FrictionState FrictionAtStart(const ScaledContact& contact) {
  if (contact.smooth) return FrictionState::kNone;
  if (!contact.compliant) return contact.u0 == 0.0 ? FrictionAtRest(contact, 0.0) : SlipTowards(contact.u0);
  const double direction = contact.u0 < 0.0 ? -1.0 : 1.0;
  const bool slides = ParticleSlides(contact, {}, MotionAtStart(contact), direction);
  return slides ? SlipTowards(direction) : FrictionState::kStick;
}

FrictionState FrictionAfter(const ScaledContact& contact, const Mode& mode, const Motion& y, Guard fallen) {
  if (contact.compliant) return CompliantFrictionAfter(contact, mode, y, fallen);
  if (mode.Sticks()) return fallen == kUpper ? FrictionState::kSlipForward : FrictionState::kSlipBackward;
  return FrictionAtRest(contact, ForcesAt(contact, mode, y).normal);
}

bool NeverReverses(const ScaledContact& contact, const Mode& mode, const Motion& y) {
  if (!mode.Sticks() || contact.compliant || contact.stick_slope != 0.0 || y[kV] >= 0.0) return false;
  // The friction cone is linear in N, so that it holds everywhere if it holds here and at infinity.
  const Forces forces = ForcesAt(contact, mode, y);
  return contact.holds_freely && AccelerationAt(contact, mode, forces).v <= 0.0;
}

}  // namespace ricochet::finite_duration
