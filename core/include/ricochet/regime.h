// Regime: the course of the contact during the impact, in one word.

#ifndef RICOCHET_REGIME_H_
#define RICOCHET_REGIME_H_

namespace ricochet {

// The numbers are those of ricochet.v1.Regime.
enum class Regime {
  kUnspecified = 0,
  kFrictionless = 1,           // No friction is possible or needed, or the plan leaves it out: e_N = e_P = e_E.
  kRebound = 2,                // Pendulum, 0 < x < 1: slip reverses where compression ends.
  kSliding = 3,                // Slip never stops. In a plane it keeps its direction; in space it may turn.
  kStickInCompression = 4,     // Slip stops in compression and the contact sticks.
  kStickInRestitution = 5,     // Slip stops in restitution and the contact sticks.
  kReversalInCompression = 6,  // Slip reverses in compression.
  kReversalInRestitution = 7,  // Slip reverses in restitution.
  kLocked = 8,       // The constraints and friction hold the body: velocities and coefficients of restitution are 0.
  kWedged = 9,       // The contact had not separated when the computation ended; Outcome::termination says why.
  kSeparating = 10,  // The contact does not approach: nothing changes.
  kInvalid = 11,     // Sweeps and batches only: the point breaks a rule or overflows; its columns are quiet NaN.
  kByLaw = 12,       // An impact law gives the end of the impact but not its course: no phases are known.
  kNoSolution = 13,  // The impact law has no solution: there is no impulse, and nothing changes.
};
inline constexpr int kRegimeCount = 14;

// True if the impact was computed and an end of it is known.
constexpr bool HasEnd(Regime regime) {
  return regime != Regime::kInvalid && regime != Regime::kWedged && regime != Regime::kNoSolution;
}

}  // namespace ricochet

#endif  // RICOCHET_REGIME_H_
