#include "core/plan/explain.h"

#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "core/plan/perturbed_path.h"

namespace ricochet {
namespace {

std::string Digits(double value) { return absl::StrFormat("%.3g", value); }

std::string Percent(double share) { return absl::StrCat(Digits(100.0 * share), " %"); }

Basis BasisOf(Effect effect, const PlannedEffects::Facts& facts) {
  return static_cast<Basis>(facts[static_cast<size_t>(effect)].basis);
}

// Names the kind of contact to which the facts of a plan belong.
enum class ContactKind { kPlanar, kPendulum, kSpatial };

ContactKind KindOf(const PlannedEffects::Facts& facts) {
  if (BasisOf(Effect::kHigherOrder, facts) != Basis::kNotOfSystem) return ContactKind::kPendulum;
  return BasisOf(Effect::kSlipTurn, facts) != Basis::kNotOfSystem ? ContactKind::kSpatial : ContactKind::kPlanar;
}

std::string NotInScene(Effect effect, ContactKind kind) {
  switch (effect) {
    case Effect::kFriction:
      return kind == ContactKind::kPendulum ? "mu |b| = 0: there is no friction" : "mu = 0: the surface is smooth";
    case Effect::kSlipStop:
    case Effect::kSlipTurn:
      return "without friction slip does not change";
    case Effect::kStaticFriction:
      return "the static and the kinetic coefficient are equal";
    case Effect::kTangentialCompliance:
      return "the contact is rigid along the surface";
    case Effect::kFiniteDuration:
      return "the scene has no normal spring: the impact takes no time";
    case Effect::kFiniteForces:
      return "the scene has no finite forces";
    case Effect::kHigherOrder:
      return "x = 0: the first-order formulas are exact";
    case Effect::kUnspecified:
      break;
  }
  return "";
}

std::string ByInequality(Effect effect, const Size& size, ContactKind kind) {
  const std::string most = absl::StrCat("velocities by at most ", Digits(size.value));
  switch (effect) {
    case Effect::kFriction: {
      const char* name = kind == ContactKind::kPendulum  ? "x = mu |b|/a"
                         : kind == ContactKind::kSpatial ? "mu |wtn|/Wnn"
                                                         : "mu |Wtn|/Wnn";
      return absl::StrCat(name, " = ", Digits(size.number), ": friction changes ", most);
    }
    case Effect::kSlipStop:
      return absl::StrCat("slip may stop after ", Percent(size.number), " of the normal impulse, which changes ", most);
    case Effect::kSlipTurn:
      return absl::StrCat("slip turns by at most ", Digits(size.number), " rad, which changes ", most);
    case Effect::kStaticFriction:
      return absl::StrCat("slip may stop after ", Percent(size.number),
                          " of the normal impulse; the choice of the coefficient then changes ", most);
    case Effect::kTangentialCompliance:
      return absl::StrCat("the contact may stick; by the bound for friction this changes ", most);
    case Effect::kFiniteForces:
      return absl::StrCat("forces act for at most ", Digits(size.number), " s, which changes ", most);
    case Effect::kHigherOrder:
      return absl::StrCat("x = mu |b|/a = ", Digits(size.number), ": terms beyond first order change ", most);
    case Effect::kFiniteDuration:
    case Effect::kUnspecified:
      break;
  }
  return "";
}

std::string WithoutInequality(Effect effect, const Size& size) {
  switch (effect) {
    case Effect::kFiniteForces:
      return size.number < kUnbounded ? "slip may stop, and no bound is known for that case"
                                      : "the forces are too strong for a bound on the duration of the contact";
    case Effect::kHigherOrder:
      return absl::StrCat("x = mu |b|/a = ", Digits(size.number), ": the first-order formulas do not hold");
    case Effect::kFiniteDuration:
      return "only the forces that press on the contact keep it closed";
    default:
      return "no bound is known once slip may stop or turn by a large angle";
  }
}

std::string SlidesThroughout(Effect effect, const Size& size, ContactKind kind) {
  if (effect == Effect::kTangentialCompliance) return "the contact slides throughout";
  const char* ends = kind == ContactKind::kSpatial ? "it stays above " : "it ends at ";
  return absl::StrCat("slip never stops: ", ends, Digits(size.number), " m/s");
}

std::string ReasonOf(Effect effect, const Size& size, ContactKind kind) {
  switch (size.basis) {
    case Basis::kNotInScene:
      return NotInScene(effect, kind);
    case Basis::kNotOfSystem:
      return effect == Effect::kSlipTurn ? "in a plane slip cannot turn" : "only a pendulum has first-order formulas";
    case Basis::kImmobile:
      return "Wtt = 0: no tangential impulse moves the contact";
    case Basis::kSlidesThroughout:
      return SlidesThroughout(effect, size, kind);
    case Basis::kStraight:
      return "Wtt is the same in all directions and wtn = 0: slip keeps its direction";
    case Basis::kDecidesNothing:
      return "the contact sticks with both coefficients of friction or with neither";
    case Basis::kNoSpring:
      return "the scene has no normal spring: forces have no time to act";
    case Basis::kSameImpulses:
      return "it gives the duration and the forces, and does not change velocities and impulses by itself";
    case Basis::kInequality:
      return ByInequality(effect, size, kind);
    case Basis::kSelfLocking:
      return absl::StrCat("friction may lock the contact, as the coefficient times |Wtn| is ", Digits(size.number),
                          " Wnn: no bound is known");
    case Basis::kStaysAtRest:
      return "there is no slip at the start, and the contact sticks";
    case Basis::kStopsAtCompressionEnd:
      return "slip stops at the end of compression, as for every pendulum";
    case Basis::kNoInequality:
      return WithoutInequality(effect, size);
    case Basis::kDamped:
      return "the damping of the spring determines the restitution";
  }
  return "";
}

bool IsLeftOut(const PlannedEffects::Fact& fact) {
  return fact.decision == Decision::kNegligible || fact.decision == Decision::kExcluded;
}

std::string Separates(Effect /*effect*/, const PlannedEffects::Facts& /*facts*/) {
  return "the contact separates: nothing changes";
}

std::string ForContact(Effect effect, const PlannedEffects::Facts& facts) {
  const PlannedEffects::Fact& fact = facts[static_cast<size_t>(effect)];
  if (kOnFriction.Has(effect) && IsLeftOut(fact) && IsLeftOut(facts[static_cast<size_t>(Effect::kFriction)])) {
    return "included in the change by friction";
  }
  const Basis basis = BasisOf(effect, facts);
  std::string reason = ReasonOf(effect, {.value = fact.size, .basis = basis, .number = fact.number}, KindOf(facts));
  // The other effects are sized for the impact without finite forces, which is what is left after these.
  const bool has_forces = facts[static_cast<size_t>(Effect::kFiniteForces)].decision == Decision::kSimulated;
  const bool is_of_path = basis == Basis::kInequality || basis == Basis::kSlidesThroughout ||
                          basis == Basis::kDecidesNothing || basis == Basis::kStaysAtRest;
  if (!has_forces || !is_of_path || effect == Effect::kFiniteForces) return reason;
  return absl::StrCat("without the finite forces, ", reason);
}

}  // namespace

void Explain(const Choice& choice, const Demand& demand, Plan& plan) {
  plan.model = choice.model;
  plan.relative_tolerance = demand.relative_tolerance;
  plan.neglected = choice.neglected;
  plan.effects.SetAuthor(choice.model == Model::kNone ? Separates : ForContact);
  for (const Effect effect : kEffects) {
    const Size& size = choice.sizes[effect];
    plan.effects[effect] = {.size = size.value,
                            .number = size.number,
                            .decision = choice.decisions[static_cast<size_t>(effect)],
                            .basis = static_cast<int>(size.basis)};
  }
}

}  // namespace ricochet
