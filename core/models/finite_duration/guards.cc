#include "core/models/finite_duration/guards.h"

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

}  // namespace ricochet::finite_duration
