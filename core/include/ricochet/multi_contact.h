// Several contacts at once: what bodies can do that touch at up to 16 points when they strike.
//
// Rigid bodies alone do not determine that impact. Three answers are given, each with its own promise
// (docs/theory/several_contacts.md):
//   orders    the outcomes of one impact after the other, for every order in which approaching contacts can be hit
//   springs   the limit of stiff springs at the contacts whose stiffnesses keep fixed ratios
//   possible  bounds that no outcome exceeds, of whatever order, stiffness or law that takes energy
// Every outcome of orders and springs that ended lies within `possible`. Friction is Coulomb's, with one coefficient;
// restitution is energetic at each contact. Contacts and bodies are counted from 1. The numbers of a contact stand in
// the order t, n in a plane and t1, t2, n in space, one contact after the other. Units are SI.

#ifndef RICOCHET_MULTI_CONTACT_H_
#define RICOCHET_MULTI_CONTACT_H_

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "ricochet/engine_info.h"
#include "ricochet/system.h"

namespace ricochet {

// More contacts than this are not taken.
inline constexpr int kMostContacts = 16;
// Orders are searched for at most this many contacts.
inline constexpr int kMostContactsInOrders = 6;
inline constexpr int kMostOrdersListed = 8;

// W = J M^-1 J^T of all contacts, symmetric and positive semidefinite, and their velocity before, which lies in the
// range of W. There are d = 2 or 3 numbers for each contact, as the length of `velocity_m_s` says.
struct ContactMatrix {
  std::vector<double> w_per_kg = {};  // All kd x kd entries, row by row.
  std::vector<double> velocity_m_s = {};
  friend bool operator==(const ContactMatrix&, const ContactMatrix&) = default;
};

// A free rigid body, in a plane with coordinates (x, y) or in space with (x, y, z). All vectors have these directions.
struct FreeBody {
  double mass_kg = 0.0;  // > 0
  // In a plane one number > 0; in space 11, 12, 13, 22, 23, 33 as of SpatialBody.
  std::vector<double> inertia_com_kg_m2 = {};
  std::vector<double> position_m = {};     // The place of the centre of mass.
  std::vector<double> linear_m_s = {};     // The velocity of the centre of mass before; empty: at rest.
  std::vector<double> angular_rad_s = {};  // One number in a plane, three in space; empty: 0.
  friend bool operator==(const FreeBody&, const FreeBody&) = default;
};

// Bodies that touch each other and the ground, which is at rest.
struct FreeBodies {
  std::vector<FreeBody> bodies = {};
  friend bool operator==(const FreeBodies&, const FreeBodies&) = default;
};

// The Jacobian of a Mechanism has the d rows of each contact, one contact after the other. std::monostate means that
// the request stated none, which is a violation. A diagonal entry of W is 0 or at least 2^-460 of the largest.
using MultiContactSystem = std::variant<std::monostate, ContactMatrix, FreeBodies, Mechanism>;

struct MultiContactPoint {
  double friction = 0.0;                 // Coulomb's coefficient, kinetic and static, from 0 to 1e9
  std::optional<double> energetic = {};  // Stronge's coefficient of restitution, in [0, 1]. Required.
  // Stiffness of this contact relative to that of the others, > 0; unset: 1. Only springs use it.
  std::optional<double> relative_stiffness = {};
  // Only FreeBodies have these. The normal points out of the other body, or the ground, into the body; its length does
  // not matter. In a plane t = (n_y, -n_x), so that t points to the right where n points up. In space t1 is the x axis
  // without its part along n, or the y axis if |n_x| > 0.9, and t2 = n x t1.
  int32_t body = 0;                  // From 1.
  int32_t other_body = 0;            // From 1; 0 is the ground.
  std::vector<double> point_m = {};  // Where they touch.
  std::vector<double> normal = {};
  friend bool operator==(const MultiContactPoint&, const MultiContactPoint&) = default;
};

struct MultiContactScene {
  MultiContactSystem system = {};
  std::vector<MultiContactPoint> contacts = {};  // 1 to kMostContacts.
  friend bool operator==(const MultiContactScene&, const MultiContactScene&) = default;
};

// Numbers of each contact, 2 in a plane or 3 in space; 0 if no system is set, or the lengths of its lists do not tell.
int DirectionsOf(const MultiContactScene& scene);

// The numbers are those of ricochet.v1.MultiContactRequest.Method.
enum class MultiContactMethod { kUnspecified = 0, kOrders = 1, kSprings = 2, kPossible = 3 };

// A velocity before that takes the place of the scene's: the kd contact velocities of a ContactMatrix, the rates of a
// mechanism, or body after body its linear and its angular velocity.
struct MultiContactState {
  std::vector<double> velocity = {};
  friend bool operator==(const MultiContactState&, const MultiContactState&) = default;
};

// A linear function of the velocities of the system, which are listed as in MultiContactState, that gets bounds too.
struct LinearOutput {
  std::string name = {};
  std::vector<double> coefficients = {};  // One for each component of the velocity.
  friend bool operator==(const LinearOutput&, const LinearOutput&) = default;
};

// Asks for the outcomes of springs while the relative stiffness of one contact runs from `low` to `high`.
struct StiffnessRange {
  int32_t contact = 0;  // From 1.
  double low = 0.0;     // > 0
  double high = 0.0;    // > low, at most 1e12 low
  friend bool operator==(const StiffnessRange&, const StiffnessRange&) = default;
};

struct MultiContactRequest {
  MultiContactScene scene = {};
  std::vector<MultiContactState> states = {};  // Each gets an answer; if there is none, the scene's own velocity does.
  std::vector<MultiContactMethod> methods = {};  // Empty: each that the scene allows.
  std::vector<LinearOutput> outputs = {};
  std::optional<StiffnessRange> stiffness_range = {};
  friend bool operator==(const MultiContactRequest&, const MultiContactRequest&) = default;
};

// Says how a sequence of impacts, or the motion on springs, ended. The numbers are those of
// ricochet.v1.AttainedOutcome.End.
enum class MultiContactEnd {
  kUnspecified = 0,
  kSeparated = 1,        // No contact approaches any more.
  kEndless = 2,          // It takes infinitely many impacts; the numbers are their limit, which is proved.
  kEndlessEstimate = 3,  // As kEndless, but the limit is where the speeds of approach fell to rounding.
  kWedged = 4,           // Contacts jam: forces stay for ever, and only the velocities are an answer.
  kBudgetUsedUp = 5,     // The numbers are those of the state that was reached, or to which the sequence came back.
  kUndetermined = 6,     // Two plastic contacts let go at one instant, and the limit depends on how plastic each is.
};

// A ContactLedger says what one contact did. Works are in J; a coefficient is unset where the contact did not approach
// or was not pressed.
struct ContactLedger {
  double work_compression_j = 0.0;  // <= 0
  double work_restitution_j = 0.0;  // energetic^2 times as much, or 0 where friction locks it; >= 0
  double work_friction_j = 0.0;     // <= 0
  std::optional<double> newton;     // -v_n after/v_n before
  std::optional<double> poisson;    // Normal impulse of restitution over that of compression.
  friend bool operator==(const ContactLedger&, const ContactLedger&) = default;
};

// An outcome that some order of impacts, or some ratio of stiffnesses, attains. Errors are those of the computation for
// W and the velocity before as doubles have them; a number is within its error of the exact one. Where
// `error_is_proved` is false they are estimates.
struct AttainedOutcome {
  // The first kMostOrdersListed orders found that end with this outcome, such as "1-2-1"; "1-(2-1)" if the part in
  // brackets repeats without end. The other numbers are those of the first. Empty for springs.
  std::vector<std::string> orders;
  int64_t order_count = 0;  // So many of the orders found end with it.
  MultiContactEnd end = MultiContactEnd::kUnspecified;
  int64_t events = 0;                              // Impacts, or events on springs.
  std::vector<double> contact_velocity_m_s;        // After: kd numbers.
  std::vector<double> contact_velocity_error_m_s;  // One for each; infinite if none is known, as the others are.
  std::vector<double> velocity;                    // The velocity of the system after, listed as in MultiContactState.
  std::vector<double> velocity_error;              // One for each.
  std::vector<double> impulse_n_s;                 // kd numbers; empty if wedged.
  std::vector<double> normal_impulse_error_n_s;    // One for each contact; empty if none is known.
  // False if the tangential impulses are one of many with the same effect, as at two feet on one floor.
  bool friction_split_is_unique = true;
  std::vector<ContactLedger> contacts;
  double energy_change_j = 0.0;  // If wedged: of the velocities, as there are no works.
  double work_error_j = 0.0;     // The error of each work and of the change of energy; infinite if none is known.
  bool error_is_proved = false;
  friend bool operator==(const AttainedOutcome&, const AttainedOutcome&) = default;
};

// Says how two contacts are coupled: cosine = -W_n1n2/sqrt(W_n1n1 W_n2n2), the cosine of an angle theta.
struct ContactPair {
  int32_t contact_1 = 0, contact_2 = 0;
  double cosine = 0.0;
  // m if theta is pi/m to within one ulp of the cosine: elastic impacts of the two without friction then end the same
  // in either order.
  std::optional<int32_t> divisor;
  friend bool operator==(const ContactPair&, const ContactPair&) = default;
};

// Bounds on one output over all outcomes that are possible.
struct PossibleRange {
  // "contact_1.t" (t1, t2 and n in space), "body_1.x", "body_1.rate" (rate_x and so on in space), "rate_1" of a
  // mechanism, or the name of a LinearOutput.
  std::string output;
  double lower = 0.0;
  double upper = 0.0;
  friend bool operator==(const PossibleRange&, const PossibleRange&) = default;
};

// One sample of the outcomes of springs over a StiffnessRange.
struct StiffnessSample {
  double relative_stiffness = 0.0;
  AttainedOutcome outcome;
  friend bool operator==(const StiffnessSample&, const StiffnessSample&) = default;
};

// Says where the outcome of springs jumps, or changes more steeply than samples resolve: between two neighbouring
// samples.
struct StiffnessJump {
  double low = 0.0, high = 0.0;  // Relative stiffnesses.
  double difference = 0.0;       // The largest change of an output, over its scale (see differing_output).
  friend bool operator==(const StiffnessJump&, const StiffnessJump&) = default;
};

// Says whether the order of impacts matters. The numbers are those of ricochet.v1.MultiContactAnswer.Verdict.
enum class MultiContactVerdict {
  kUnspecified = 0,               // Not decided: no two orders end apart, but some have no end or large errors.
  kSingle = 1,                    // Proved: only one outcome is possible.
  kOrderMatters = 2,              // Two orders end apart by more than their errors and 1e-11 of an output's scale.
  kOrdersAgreeSpringsDiffer = 3,  // All orders end alike, but springs end differently.
  kOrdersAgree = 4,               // Neither was found to differ. This proves no uniqueness.
};

struct RefusedMethod {
  MultiContactMethod method = MultiContactMethod::kUnspecified;  // One that the scene does not allow,
  std::string reason;                                            // or outcomes that the answer leaves out.
  friend bool operator==(const RefusedMethod&, const RefusedMethod&) = default;
};

// A MultiContactAnswer says what the contacts can do from one velocity before.
struct MultiContactAnswer {
  MultiContactVerdict verdict = MultiContactVerdict::kUnspecified;
  // These are set if two outcomes that ended differ: the output that differs most over its scale, by how much, and in
  // which two outcomes. The scale is sqrt(2 T g): T is energy_before_j, and an impulse that changes the
  // output by one unit takes the energy 1/(2 g).
  std::string differing_output;
  double difference = 0.0;
  std::string outcome_1, outcome_2;  // An order, "springs", or springs of a sample.
  std::vector<double> contact_velocity_before_m_s;
  double energy_before_j = 0.0;  // The least energy that goes with the contact velocity.
  bool jams = false;             // Impulses within the cones of friction exist that move nothing.
  std::vector<ContactPair> pairs;
  std::vector<AttainedOutcome> orders;
  std::optional<AttainedOutcome> springs;
  std::vector<StiffnessSample> stiffness_samples;
  std::vector<StiffnessJump> stiffness_jumps;
  std::vector<PossibleRange> possible;
  std::vector<RefusedMethod> refused;
  friend bool operator==(const MultiContactAnswer&, const MultiContactAnswer&) = default;
};

struct MultiContactResponse {
  std::vector<MultiContactAnswer> answers;  // One for each state.
  EngineInfo engine;
  friend bool operator==(const MultiContactResponse&, const MultiContactResponse&) = default;
};

}  // namespace ricochet

#endif  // RICOCHET_MULTI_CONTACT_H_
