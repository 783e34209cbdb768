// Regime: what the contact point did, in one word.

#ifndef RICOCHET_REGIME_H_
#define RICOCHET_REGIME_H_

namespace ricochet {

// What the contact point did. The numbers are those of ricochet.v1.Regime.
enum class Regime {
  kUnspecified = 0,
  kFrictionless = 1,  // x = mu |b|/a = 0: no tangential coupling, the three coefficients are equal.
  kRebound = 2,       // Pendulum, 0 < x < 1: slip reverses where compression ends.
  kSliding = 3,
  kStickInCompression = 4,
  kStickInRestitution = 5,
  kReversalInCompression = 6,
  kReversalInRestitution = 7,
  kLocked = 8,       // The pin and friction hold the body: no restitution, velocities 0, coefficients 0.
  kWedged = 9,       // It has not ended, as far as its model has followed it: the error is infinite.
  kSeparating = 10,  // The contact does not approach: nothing changes.
  kInvalid = 11,     // Sweeps and batches only: a point that breaks a rule or overflows; its columns are quiet NaN.
  kByLaw = 12,       // An impact law says how the impact ends, not how it goes on: nothing is known by phases.
  kNoSolution = 13,  // An impact law contradicts itself: no impulse, nothing changes.
};
inline constexpr int kRegimeCount = 14;

}  // namespace ricochet

#endif  // RICOCHET_REGIME_H_
