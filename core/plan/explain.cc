#include "core/plan/explain.h"

#include <array>
#include <charconv>
#include <string>

#include "absl/strings/str_cat.h"
#include "core/plan/perturbed_path.h"

namespace ricochet {
namespace {

std::string Digits(double value) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 3);
  return std::string(text.data(), end.ptr);
}

std::string Percent(double share) { return absl::StrCat(Digits(100.0 * share), " %"); }

// Which kind of contact the sizes are of.
bool IsPendulum(const Sizes& sizes) { return sizes[Effect::kHigherOrder].ground != Ground::kNotOfSystem; }
bool IsInSpace(const Sizes& sizes) { return sizes[Effect::kSlipTurn].ground != Ground::kNotOfSystem; }

std::string NotInScene(Effect effect, const Sizes& sizes) {
  switch (effect) {
    case Effect::kFriction:
      return IsPendulum(sizes) ? "mu |b| = 0: friction does not act" : "mu = 0: the surface is smooth";
    case Effect::kSlipStop:
    case Effect::kSlipTurn:
      return "there is no friction to change slip";
    case Effect::kStaticFriction:
      return "the static coefficient is the kinetic one";
    case Effect::kTangentialCompliance:
      return "the contact is rigid along the surface";
    case Effect::kFiniteDuration:
      return "no normal spring is stated: the impact takes no time";
    case Effect::kFiniteForces:
      return "there are no finite forces";
    case Effect::kHigherOrder:
      return "x = 0: the first order is exact";
    case Effect::kUnspecified:
      break;
  }
  return "";
}

std::string ByInequality(Effect effect, const Size& size, const Sizes& sizes) {
  const std::string most = absl::StrCat("velocities by at most ", Digits(size.value));
  switch (effect) {
    case Effect::kFriction: {
      const char* name = IsPendulum(sizes) ? "x = mu |b|/a" : IsInSpace(sizes) ? "mu |wtn|/Wnn" : "mu |Wtn|/Wnn";
      return absl::StrCat(name, " = ", Digits(size.number), ": friction changes ", most);
    }
    case Effect::kSlipStop:
      return absl::StrCat("slip may stop after ", Percent(size.number), " of the normal impulse, which changes ", most);
    case Effect::kSlipTurn:
      return absl::StrCat("slip turns by at most ", Digits(size.number), " rad, which changes ", most);
    case Effect::kStaticFriction:
      return absl::StrCat("slip may rest after ", Percent(size.number),
                          " of the normal impulse; which coefficient holds it then changes ", most);
    case Effect::kTangentialCompliance:
      return absl::StrCat("the particle may stick, where no inequality but those of friction is known; it changes ",
                          most);
    case Effect::kFiniteForces:
      return absl::StrCat("forces act for at most ", Digits(size.number), " s, which changes ", most);
    case Effect::kHigherOrder:
      return absl::StrCat("x = mu |b|/a = ", Digits(size.number), ": what is beyond first order changes ", most);
    case Effect::kFiniteDuration:
    case Effect::kUnspecified:
      break;
  }
  return "";
}

std::string WithoutInequality(Effect effect, const Size& size) {
  switch (effect) {
    case Effect::kFiniteForces:
      return size.number < kUnbounded ? "slip may stop, where no inequality is known"
                                      : "the forces are too strong for a bound on how long the contact lasts";
    case Effect::kHigherOrder:
      return absl::StrCat("x = mu |b|/a = ", Digits(size.number), ": the first-order form does not serve");
    case Effect::kFiniteDuration:
      return "the contact is there only for the forces that press on it";
    default:
      return "no inequality is known once slip may stop or turn far";
  }
}

std::string SlidesThroughout(Effect effect, const Size& size, const Sizes& sizes) {
  if (effect == Effect::kTangentialCompliance) return "the particle slides throughout";
  const char* ends = IsInSpace(sizes) ? "it is never below " : "it ends at ";
  return absl::StrCat("slip never stops: ", ends, Digits(size.number), " m/s");
}

std::string ReasonOf(Effect effect, const Size& size, const Sizes& sizes) {
  switch (size.ground) {
    case Ground::kNotInScene:
      return NotInScene(effect, sizes);
    case Ground::kNotOfSystem:
      return effect == Effect::kSlipTurn ? "in a plane slip has no way to turn"
                                         : "only a pendulum has a first-order form";
    case Ground::kImmobile:
      return "Wtt = 0: no tangential impulse moves the contact";
    case Ground::kSlidesThroughout:
      return SlidesThroughout(effect, size, sizes);
    case Ground::kStraight:
      return "Wtt is the same in all directions and wtn = 0: slip keeps its own";
    case Ground::kDecidesNothing:
      return "the contact sticks by both coefficients of friction or by neither";
    case Ground::kNoSpring:
      return "no normal spring is stated: forces have no time to act";
    case Ground::kSameImpulses:
      return "it takes time, but velocities and impulses are those without; require it for contact time and forces";
    case Ground::kInequality:
      return ByInequality(effect, size, sizes);
    case Ground::kSelfLocking:
      return absl::StrCat("friction may lock the contact, the coefficient times the coupling being ",
                          Digits(size.number), " of Wnn: no inequality is known");
    case Ground::kStaysAtRest:
      return "there is no slip at the start, and the contact sticks";
    case Ground::kStopsAtRest:
      return "slip stops where compression ends, as that of every pendulum does";
    case Ground::kNoInequality:
      return WithoutInequality(effect, size);
    case Ground::kDamped:
      return "the spring's damping is the restitution";
  }
  return "";
}

std::string Reason(Effect effect, const Choice& choice) {
  if (choice.model == Model::kNone) return "the contact separates: nothing happens";
  if (kOnFriction.Has(effect) && choice.LeavesOut(effect) && choice.LeavesOut(Effect::kFriction)) {
    return "counted in what friction changes";
  }
  return ReasonOf(effect, choice.sizes[effect], choice.sizes);
}

}  // namespace

Plan Explain(const Choice& choice, const Demand& demand) {
  Plan plan = {.model = choice.model, .relative_tolerance = demand.relative_tolerance, .neglected = choice.neglected};
  plan.effects.reserve(kEffectCount - 1);
  for (const Effect effect : kEffects) {
    plan.effects.push_back({.effect = effect,
                            .decision = choice.decisions[static_cast<size_t>(effect)],
                            .size = choice.sizes[effect].value,
                            .reason = Reason(effect, choice)});
  }
  return plan;
}

}  // namespace ricochet
