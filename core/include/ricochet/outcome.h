// Outcome: the answer. It holds the velocities, impulses, coefficients, works and events of one impact, and the limits
// that it breaks.
//
// The structs mirror ricochet.v1.Outcome field by field. Units are SI units and radians. Tangential quantities are
// along t, normal ones along n (ricochet/system.h); impulses act on the striking body; contact velocities are relative
// to the surface. `energy_change_j` is E+ - E- of the system and a moving surface together, negative for a loss.

#ifndef RICOCHET_OUTCOME_H_
#define RICOCHET_OUTCOME_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/container/inlined_vector.h"
#include "ricochet/certificate.h"
#include "ricochet/derivatives.h"
#include "ricochet/plan.h"
#include "ricochet/regime.h"

namespace ricochet {

// The components of a vector along t or along t1, t2, n, or one number for each link. Up to three need no memory of the
// heap.
using Components = absl::InlinedVector<double, 3>;

// An impact law says nothing about the phases of an impact: it leaves Poisson's and the energetic coefficient unset.
struct Coefficients {
  double newton = 0.0;
  std::optional<double> poisson = 0.0;
  std::optional<double> energetic = 0.0;
  // Brach's mu_hat = tangential / normal impulse, signed in a plane, its magnitude in space. Lubarda Eq. (49).
  double tangential = 0.0;
  friend bool operator==(const Coefficients&, const Coefficients&) = default;
};

// Tangential lists, here and below, have one entry for each tangential direction: one in a plane, two in space.
struct ContactVelocity {
  Components tangential_m_s;
  double normal_m_s = 0.0;
  friend bool operator==(const ContactVelocity&, const ContactVelocity&) = default;
};

struct Impulse {
  std::optional<double> normal_compression_n_s = 0.0;  // tau0; unset under an impact law.
  double normal_total_n_s = 0.0;                       // tau1
  Components tangential_n_s;                           // f1
  friend bool operator==(const Impulse&, const Impulse&) = default;
};

// Work of the contact impulse on the body, by direction and phase. All four are <= 0 but those of restitution. An
// impact law has no phases: all four are then unset, and the residual is that of the two totals.
struct WorkLedger {
  std::optional<double> normal_compression_j = 0.0;
  std::optional<double> normal_restitution_j = 0.0;
  std::optional<double> tangential_compression_j = 0.0;
  std::optional<double> tangential_restitution_j = 0.0;  // > 0 where a tangential spring gives back energy.
  double normal_total_j = 0.0;          // -(energy lost to irreversible deformation), Lubarda Eq. (37).
  double tangential_total_j = 0.0;      // -(energy lost to friction and left in a tangential spring), Lubarda Eq. (35).
  double friction_dissipation_j = 0.0;  // < 0 only where an impact law lets friction give energy.
  double tangential_spring_j = 0.0;     // Energy left in the tangential spring of a compliant contact, and lost. >= 0.
  double residual_j = 0.0;              // Sum of the four works minus energy_change_j: rounding only.
  friend bool operator==(const WorkLedger&, const WorkLedger&) = default;
};

// An event is an instant at which the motion of the contact changes. For a rigid contact in a plane, every quantity is
// linear in the normal impulse between two events. The numbers are those of ricochet.v1.Event.Kind.
enum class EventKind {
  kUnspecified = 0,
  kStart = 1,
  kSlipStops = 2,
  kCompressionEnds = 3,
  kRestitutionEnds = 4,
  kSlipStarts = 5,
  kStickStarts = 6,
  kEndRecedes = 7,
};

// The state of the contact once the normal impulse has reached `normal_impulse_n_s`.
struct State {
  double normal_impulse_n_s = 0.0;    // tau, the paper's independent variable, Eq. (3).
  Components tangential_impulse_n_s;  // f(tau), Eq. (48).
  ContactVelocity contact_velocity;   // u(tau), v(tau).
  Components rates_rad_s;             // omega(tau), Eq. (9): one for each link; empty for systems without joints.
  friend bool operator==(const State&, const State&) = default;
};

struct Event {
  EventKind kind = EventKind::kUnspecified;
  State state;
  friend bool operator==(const Event&, const Event&) = default;
};

// The numbers are those of ricochet.v1.BrokenLimit.Kind.
enum class LimitKind {
  kUnspecified = 0,
  kSharp = 1,     // Implied energetic coefficient > 1: the spring gives back more than it stored. Eq. (29).
  kEnergy = 2,    // Kinetic energy is created: E+ > E-. Eqs. (27), (28).
  kFriction = 3,  // Friction does positive work: it pushes along the slip instead of against it.
};

// A BrokenLimit says why an outcome is inadmissible.
struct BrokenLimit {
  LimitKind kind = LimitKind::kUnspecified;
  // kSharp: the implied energetic coefficient; kEnergy: E+ - E- in J; kFriction: the work of friction in J.
  double value = 0.0;
  double limit = 0.0;   // kSharp: 1; kEnergy and kFriction: 0.
  double excess = 0.0;  // value - limit, without cancellation.
  friend bool operator==(const BrokenLimit&, const BrokenLimit&) = default;
};

// The velocity of a free body. In space its components are along and about t1, t2 and n; in a plane the linear ones are
// along t and n, and the angular one is counter-clockwise.
struct BodyVelocity {
  Components linear_m_s;
  Components angular_rad_s;
  friend bool operator==(const BodyVelocity&, const BodyVelocity&) = default;
};

// Says how the computation of an impact ended. The numbers are those of ricochet.v1.Termination.
enum class Termination {
  kUnspecified = 0,
  kConverged = 1,  // The impact was followed to its end, with a stated error within the tolerance if that is above 0.
  // The model's budget of steps ran out first. The outcome is the state reached, its error infinite.
  kBudgetUsedUp = 2,
  // The model gave up: friction or a spring holds the contact for ever, rounding has destroyed the path, or an impact
  // law has no solution. The outcome is the state reached, and its error is infinite except under a law.
  kRefused = 3,
  // The impact was followed to its end, but the stated error exceeds the tolerance asked for, which is above 0.
  kLessAccurate = 4,
};

// True if the impact was followed to its end.
constexpr bool HasEnd(Termination termination) {
  return termination == Termination::kConverged || termination == Termination::kLessAccurate;
}

// The coefficients that the impact was computed with: those of the scene at its approach speed.
struct EffectiveCoefficients {
  double kinetic_friction = 0.0;
  double static_friction = 0.0;
  // In the scene's definition; e for an impact law. Unset if the scene states none: a spring's damping stands for it.
  std::optional<double> restitution;
  friend bool operator==(const EffectiveCoefficients&, const EffectiveCoefficients&) = default;
};

// The numbers are those of ricochet.v1.Accuracy.Kind.
enum class AccuracyKind {
  kUnspecified = 0,
  kBound = 1,     // The true error is proved to be no larger.
  kEstimate = 2,  // No test has found a true error that is larger, but there is no proof.
};

// Accuracy of the outcome, with W and the velocity before it taken as exact, and the effort of the computation.
struct Accuracy {
  // Error of each component of the contact velocity after the impact, over V = max(|u0|, |v0|). It says nothing of the
  // other numbers: `errors` states how far each of them may be off, in the number's own unit, and leaves unset what is
  // not known.
  double relative_error = 0.0;
  AccuracyKind kind = AccuracyKind::kUnspecified;
  int64_t steps = 0;             // 0 for a closed form.
  int64_t right_hand_sides = 0;  // 0 for a closed form.
  friend bool operator==(const Accuracy&, const Accuracy&) = default;
};

// Errors of the numbers of an outcome, each in the unit of its number and not below the true error: W, the velocity
// before and the coefficients of the scene are taken as exact. Accuracy::kind says if they are proved or estimated.
// A number without an error has none that is known. The error of a tangential quantity holds for each component.
// `friction_dissipation_j` and the total works err by no more than the sum of the errors of their two phases.
struct NumberErrors {
  std::optional<double> newton, poisson, energetic, tangential;  // Coefficients
  std::optional<double> tangential_m_s, normal_m_s;              // ContactVelocity after the impact
  std::optional<double> normal_compression_n_s, normal_total_n_s, tangential_n_s;
  std::optional<double> normal_compression_j, normal_restitution_j;
  std::optional<double> tangential_compression_j, tangential_restitution_j;
  std::optional<double> energy_change_j;
  // The errors of Outcome::rates_after and momentum_change, entry by entry, infinite where no bound is known. These
  // take M, J and q' as exact, but not W and the contact velocity that they were reduced to (docs/theory/mechanism.md).
  Components rates_after, momentum_change;
  friend bool operator==(const NumberErrors&, const NumberErrors&) = default;
};

// The subject of a note. The numbers are those of ricochet.v1.Note.Kind.
enum class NoteKind {
  kUnspecified = 0,
  kDurationLeftOut = 1,  // The scene has a normal spring, but the answer has no duration and no forces.
  kLargeAngle = 2,       // An angle is beyond a full turn, as a number of degrees would be.
  kManySolutions = 3,    // Other impulses solve the same impact; the answer holds one of them.
  kUndetermined = 4,     // A part of the motion does not depend on the contact, or cannot be known from it.
  kTimelineCut = 5,      // The timeline has its first events and the end, but not those between.
};

// Something that a caller should know about an answer and that no number of it says.
struct Note {
  NoteKind kind = NoteKind::kUnspecified;
  std::string path;  // The field of the scene or of the outcome that the note is about: "linkage.links[1].theta_rad".
  std::string text;  // One sentence, which says what to do about it.
  friend bool operator==(const Note&, const Note&) = default;
};

// The forces at one instant of an impact that takes time, and the contact's state.
struct ForceSample {
  double time_s = 0.0;
  double tangential_n = 0.0;
  double normal_n = 0.0;
  double indentation_m = 0.0;
  double tangential_m_s = 0.0;
  double normal_m_s = 0.0;
  friend bool operator==(const ForceSample&, const ForceSample&) = default;
};

// Duration, peaks and force history of an impact that takes time.
struct ContactDuration {
  double duration_s = 0.0;
  double peak_normal_n = 0.0;
  double peak_tangential_n = 0.0;  // Largest magnitude of the tangential force.
  double indentation_m = 0.0;      // Largest indentation.
  // Samples at equal steps of time from first to last touch, if SolveRequest::force_intervals asks for them.
  std::vector<ForceSample> history;
  friend bool operator==(const ContactDuration&, const ContactDuration&) = default;
};

// An impact law may allow several ends of an impact; this is one of them.
struct ImpactSolution {
  ContactVelocity contact_velocity_after;
  Impulse impulse;
  friend bool operator==(const ImpactSolution&, const ImpactSolution&) = default;
};

// The end of an impact in which no coordinate of a mechanism is held.
struct FreeEnd {
  Regime regime = Regime::kUnspecified;
  Termination termination = Termination::kConverged;
  bool admissible = true;  // False exactly if broken_limits is not empty.
  std::vector<BrokenLimit> broken_limits;
  Coefficients coefficients;
  Components rates_after;
  ContactVelocity contact_velocity_after;
  Impulse impulse;
  NumberErrors errors;
  friend bool operator==(const FreeEnd&, const FreeEnd&) = default;
};

struct Outcome {
  Regime regime = Regime::kUnspecified;
  Termination termination = Termination::kConverged;
  bool admissible = true;  // False exactly if broken_limits is not empty.
  std::vector<BrokenLimit> broken_limits;
  int w_rank = 0;                // Rank of the contact-space inverse inertia W; 1 for a pendulum.
  Coefficients coefficients;     // All 0 if separating; the first three if locked.
  Components rates_after_rad_s;  // One for each link; a pendulum has omega+. Empty for systems without joints.
  ContactVelocity contact_velocity_after;
  Impulse impulse;
  WorkLedger work;
  double energy_change_j = 0.0;  // By the contact alone: what holds a moving coordinate does work of its own.
  std::vector<Event> timeline;   // In order of normal impulse, at most 8192; empty if it separates.
  std::vector<State> history;    // One for each SolveRequest.history_at_n_s, in that order.
  absl::InlinedVector<BodyVelocity, 2> bodies_after;  // Body 1 first. Empty for systems other than free bodies.
  EffectiveCoefficients effective;
  Accuracy accuracy;
  NumberErrors errors;
  std::vector<Note> notes;  // In the order of their kinds and fields.
  // The ends of the range of impulses that solve a Kane-Levinson law; one if the range has no other end. Empty for a
  // single solution.
  std::vector<ImpactSolution> alternatives;
  Plan plan;
  std::optional<ContactDuration> contact;  // Present exactly if the model is kFiniteDuration and the bodies touch.
  // A mechanism has these, in the units of its coordinates: q' after the impact, and M (q'+ - q'), the momentum that
  // the impact gives each coordinate. For a free one that is J^T (f, tau). A coordinate that is held takes what the
  // free ones pass on to it: less J^T (f, tau), it is the impulse of the brake or controller that holds it. Empty for
  // other systems.
  Components rates_after;
  Components momentum_change;
  std::optional<FreeEnd> free_end;         // Present exactly if SolveRequest::both_ends asks for it.
  std::optional<Certificate> certificate;  // Present exactly if SolveRequest::certified_digits asks for it.
  std::vector<Derivative> derivatives;     // One for each pair of SolveRequest::derivatives; `by` changes first.
  friend bool operator==(const Outcome&, const Outcome&) = default;
};

}  // namespace ricochet

#endif  // RICOCHET_OUTCOME_H_
