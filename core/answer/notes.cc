#include "core/answer/notes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "core/base/decimal.h"
#include "core/contact/delassus.h"
#include "core/scene/numbers.h"
#include "ricochet/number_path.h"
#include "ricochet/plan.h"

namespace ricochet {
namespace {

constexpr double kFullTurn = 2.0 * std::numbers::pi;

Note DurationLeftOut() {
  return {.kind = NoteKind::kDurationLeftOut,
          .path = "contact",
          .text =
              "The duration and the forces were left out, as velocities and impulses are within the tolerance; "
              "--require finite-duration, or EFFECT_FINITE_DURATION in `required`, asks for them."};
}

// Three digits are enough to show that an angle was meant in degrees.
std::string InRadians(double degrees) { return absl::StrFormat("%.3g", degrees * (std::numbers::pi / 180.0)); }

// This is kept out of line, so that the check of every angle stays short.
[[gnu::noinline]] Note LargeAngle(const NumberPath& path, double value) {
  const std::string number = ShortestDecimal(value);
  return {.kind = NoteKind::kLargeAngle,
          .path = path.Text(),
          .text = absl::StrCat(path.Text(), " = ", number, " rad lies beyond a full turn; write ", number, "deg or ",
                               InRadians(value), " if it is meant in degrees.")};
}

void AddUndetermined(const char* path, std::string text, Outcome& outcome) {
  outcome.notes.push_back({.kind = NoteKind::kUndetermined, .path = path, .text = std::move(text)});
}

// Adds the note for a verdict that the effects left out may reverse; they change velocities by up to `negligible` of
// the speed before. The works, and the energetic coefficient near its limit 1, then change by a few times as much; 8
// exceeds what random scenes need (VerdictNoteTest). A coefficient that is stated does not change.
void AddVerdictNote(const Restitution& restitution, double negligible, Outcome& outcome) {
  constexpr double kOfCoefficient = 8.0;
  if (!outcome.admissible || std::holds_alternative<EnergeticCoefficient>(restitution)) return;
  const std::optional<double>& energetic = outcome.coefficients.energetic;
  if (!energetic.has_value() || !(*energetic * (1.0 + kOfCoefficient * negligible) > 1.0)) return;
  if (outcome.errors.energetic.has_value() && *energetic + *outcome.errors.energetic <= 1.0) return;
  AddUndetermined("admissible",
                  "The outcome is admissible with the effects that were simulated. Those that were left out may bring "
                  "the energetic coefficient above 1; a tolerance of 0 leaves none out.",
                  outcome);
}

// `full_rank` is the rank that no joint takes anything from.
void AddJamNote(int full_rank, Outcome& outcome) {
  const bool is_rigid = outcome.plan.model == Model::kPlanar || outcome.plan.model == Model::kSpatial;
  if (!is_rigid || outcome.termination != Termination::kRefused || outcome.w_rank >= full_rank) return;
  const double v = outcome.contact_velocity_after.normal_m_s;
  const std::string speed = ShortestDecimal(std::fabs(v));
  AddUndetermined("contact_velocity_after.normal_m_s",
                  v < 0.0 ? absl::StrCat("Friction and the joints hold the contact while it approaches at ", speed,
                                         " m/s: no impulse ends the impact. It has an end with less friction.")
                          : absl::StrCat("Friction and the joints hold the contact while it parts at ", speed,
                                         " m/s: no impulse gives it the speed that Newton's coefficient asks for. "
                                         "State a smaller one, or Poisson's or the energetic coefficient."),
                  outcome);
}

bool IsAtRest(const Components& tangential) {
  return std::all_of(tangential.begin(), tangential.end(), [](double u) { return u == 0.0; });
}

// The note for a contact that friction does not move, and that does not slip.
void AddIdleFrictionNote(Outcome& outcome) {
  AddUndetermined("impulse.tangential_n_s",
                  "No tangential impulse moves the contact, and it does not slip: any impulse of friction up to the "
                  "static coefficient times the normal impulse is possible, and 0 is answered.",
                  outcome);
}

// Forces change velocities as long as the contact lasts; without them a model without time gives the same impact.
void AddTimedNote(const Scene& scene, Outcome& outcome) {
  const bool has_forces = !std::holds_alternative<std::monostate>(scene.finite_forces);
  if (outcome.plan.model != Model::kFiniteDuration || has_forces) return;
  if (outcome.termination != Termination::kBudgetUsedUp) return;
  AddUndetermined("regime",
                  "The integration in time has used up its steps. Without the duration the impact may have an end: "
                  "--exclude finite-duration, or EFFECT_FINITE_DURATION in `excluded`, asks for that.",
                  outcome);
}

// True if the exact W has full rank and the one at hand is rounded. Free bodies have such a W, though rounding may have
// made it singular; where joints take a rank away, it is exact. A W that is stated is exact, too.
bool IsRoundedOfFullRank(const Scene& scene, int full_rank, const Outcome& outcome) {
  const System& system = scene.system;
  if (std::holds_alternative<PlanarContact>(system) || std::holds_alternative<SpatialContact>(system)) return false;
  const bool is_free = std::holds_alternative<PlanarBody>(system) || std::holds_alternative<SpatialBody>(system) ||
                       std::holds_alternative<BodyPair>(system);
  return is_free || outcome.w_rank == full_rank;
}

// The determinant of W over the product of its diagonal.
double RelativeDeterminant(const spatial::Problem& of) {
  const auto cosine = [](double entry, double a, double b) { return entry / (std::sqrt(a) * std::sqrt(b)); };
  const double x = cosine(of.w12, of.w11, of.w22);
  const double y = cosine(of.w13, of.w11, of.w33);
  const double z = cosine(of.w23, of.w22, of.w33);
  return 1.0 + 2.0 * x * y * z - x * x - y * y - z * z;
}

// Adds the note for a W whose rounding can change the answer: where its entries cancel to a part d, by some 16 eps/d of
// itself. NaN, which a diagonal of 0 gives, has none.
void AddRoundingNote(double left, const std::string& why, const char* advice, Outcome& outcome) {
  constexpr double kShows = 1e-9;
  constexpr double kOfEntries = 0x1p-48;
  const double effect = left > kOfEntries ? kOfEntries / left : 1.0;
  if (!(effect > kShows) || std::isnan(left)) return;
  AddUndetermined(
      "contact_velocity_after",
      absl::StrCat(why, " that the rounding of the entries of W can change velocities and impulses by ",
                   absl::StrFormat("%.1g", effect), " of themselves, which the stated errors leave out.", advice),
      outcome);
}

// Adds notes on what the outcome cannot know. The problems have the coefficients that the model has used.
struct AddUndeterminedOf {
  const Scene& scene;
  Outcome& outcome;

  void operator()(std::monostate) const {}
  void operator()(const pendulum::Problem& problem) const {
    if (problem.b == 0.0 && problem.omega_minus < 0.0 && problem.mu_static > 0.0) AddIdleFrictionNote(outcome);
  }
  void operator()(const planar::Problem& problem) const {
    if (problem.v0 >= 0.0) return;
    AddJamNote(2, outcome);
    const PlanarDelassus w = {.tt = problem.w.tt, .tn = problem.w.tn, .nn = problem.w.nn};
    constexpr char kAdvice[] = " --certified, or certified_digits, gives digits that are proved for the scene.";
    if (IsRoundedOfFullRank(scene, 2, outcome)) {
      AddRoundingNote(w.RelativeDeterminant(), "W is so nearly singular", kAdvice, outcome);
    }
    // Slip may drive the contact into the surface nearly as much as the normal impulse drives it out.
    const double left = 1.0 - problem.mu * std::fabs(w.tn) / w.nn;
    if (!std::holds_alternative<PlanarContact>(scene.system) && problem.u0 != 0.0) {
      AddRoundingNote(std::fabs(left), "Wnn and mu |Wtn| are so nearly equal", kAdvice, outcome);
    }
    if (problem.w.tt == 0.0 && problem.u0 == 0.0 && problem.mu_static > 0.0) AddIdleFrictionNote(outcome);
  }
  void operator()(const spatial::Problem& problem) const {
    if (problem.v0 >= 0.0) return;
    AddJamNote(3, outcome);
    if (IsRoundedOfFullRank(scene, 3, outcome)) {
      AddRoundingNote(4.0 / 9.0 * RelativeDeterminant(problem), "W is so nearly singular", "", outcome);
    }
    if (!(problem.mu_static > 0.0) || !IsAtRest(outcome.contact_velocity_after.tangential_m_s)) return;
    if (problem.w11 == 0.0 && problem.w22 == 0.0) return AddIdleFrictionNote(outcome);
    if (PlanarDelassus{.tt = problem.w11, .tn = problem.w12, .nn = problem.w22}.Rank() == 2) return;
    AddUndetermined(
        "impulse.tangential_n_s",
        "Wtt is singular: part of the impulse of friction on the contact that sticks changes no velocity. The "
        "smallest impulse is answered.",
        outcome);
  }
};

}  // namespace

void AddNotes(const Scene& scene, const PlannedScene& planned, Outcome& outcome) {
  const Decision duration = planned.choice.decisions[static_cast<size_t>(Effect::kFiniteDuration)];
  if (duration == Decision::kNegligible) outcome.notes.push_back(DurationLeftOut());
  AddTimedNote(scene, outcome);
  const double negligible = planned.choice.negligible;
  if (negligible > 0.0) AddVerdictNote(scene.restitution, negligible, outcome);
  VisitNumbers(scene, [&outcome](const NumberPath& path, double value, NumberRule rule) {
    if (rule == NumberRule::kAngle && std::abs(value) > kFullTurn) outcome.notes.push_back(LargeAngle(path, value));
  });
  if (planned.choice.model != Model::kImpactLaw) std::visit(AddUndeterminedOf{scene, outcome}, planned.problem);
}

}  // namespace ricochet
