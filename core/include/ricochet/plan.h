// Plan: which effects an impact was computed with, which were left out, why, and what that can change.
//
// docs/theory/plan.md proves the size of each effect, and says how the cheapest model within a demand is chosen. Sizes
// add up: `neglected` is the sum of the sizes left out. The answer differs from the one with all effects of the scene
// by at most `neglected` plus the model's own error.

#ifndef RICOCHET_PLAN_H_
#define RICOCHET_PLAN_H_

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace ricochet {

// An effect is a part of the physics that an impact may be computed with or without. The numbers are those of
// ricochet.v1.Effect.
enum class Effect {
  kUnspecified = 0,
  kFriction = 1,
  kSlipStop = 2,              // Slip stops, and the contact then sticks or slips in reverse.
  kSlipTurn = 3,              // Slip changes its direction, in space.
  kStaticFriction = 4,        // The coefficient of static friction is above the kinetic one.
  kTangentialCompliance = 5,  // The contact deforms along the surface.
  kFiniteDuration = 6,        // The indentation takes time.
  kFiniteForces = 7,          // Finite forces such as gravity do work during the contact.
  kHigherOrder = 8,           // A pendulum's terms beyond first order in x = mu |b|/a.
};
inline constexpr int kEffectCount = 9;

// The numbers are those of ricochet.v1.PlannedEffect.Decision.
enum class Decision {
  kUnspecified = 0,
  kAbsent = 1,  // The scene does not have the effect, or it provably never comes into play.
  kSimulated = 2,
  kNegligible = 3,  // Left out: all negligible effects together change the answer within the tolerance.
  kRequired = 4,    // Simulated because the caller requires it.
  kExcluded = 5,    // Left out because the caller excludes it, whatever that changes.
};

// The decision on one effect, in words.
struct PlannedEffect {
  Effect effect = Effect::kUnspecified;
  Decision decision = Decision::kUnspecified;
  // Bound on the change that leaving the effect out makes in any contact velocity, or in an impulse times its mobility
  // (Wnn tau, Wtt f; in space (W11 + W22) |f|), divided by the approach speed |v0|. 0 if the effect is absent, or if it
  // is an effect of friction and friction itself is left out; infinite if no bound is known.
  double size = 0.0;
  std::string reason;  // One sentence that says where the size comes from, with its numbers.
  friend bool operator==(const PlannedEffect&, const PlannedEffect&) = default;
};

// Every effect once, in order of their numbers; none under an impact law. The sentences are made when they are read,
// because most are not.
class PlannedEffects {
 public:
  // The data that a decision and its sentence are made of. The number of `basis` is known to the author alone.
  struct Fact {
    double size = 0.0;
    double number = 0.0;
    Decision decision = Decision::kUnspecified;
    int basis = 0;
  };
  using Facts = std::array<Fact, kEffectCount>;  // By number; the first is not used.
  // Gives the reason for a decision.
  using Author = std::string (*)(Effect effect, const Facts& facts);

  PlannedEffects() = default;
  explicit PlannedEffects(std::vector<PlannedEffect> effects)
      : written_(std::make_shared<const std::vector<PlannedEffect>>(std::move(effects))) {}
  void SetAuthor(Author author) { author_ = author; }
  Fact& operator[](Effect effect) { return facts_[static_cast<size_t>(effect)]; }

  std::vector<PlannedEffect> List() const;
  friend bool operator==(const PlannedEffects& a, const PlannedEffects& b) { return a.List() == b.List(); }

 private:
  Author author_ = nullptr;
  Facts facts_;
  std::shared_ptr<const std::vector<PlannedEffect>> written_;
};

// The numbers are those of ricochet.v1.Model.
enum class Model {
  kUnspecified = 0,
  kNone = 1,            // The contact separates: nothing to compute.
  kFrictionless = 2,    // docs/theory/sliding.md, without friction
  kFirstOrder = 3,      // docs/theory/pendulum_numerics.md
  kSliding = 4,         // docs/theory/sliding.md
  kPendulum = 5,        // docs/theory/pendulum.md
  kPlanar = 6,          // docs/theory/planar.md
  kSpatial = 7,         // docs/theory/spatial.md
  kCompliant = 8,       // docs/theory/compliant.md
  kFiniteDuration = 9,  // docs/theory/finite_duration.md
  kImpactLaw = 10,      // docs/theory/laws.md
};
inline constexpr int kModelCount = 11;

// True if every quantity of the model's path is linear in the normal impulse from one event to the next.
constexpr bool IsLinearBetweenEvents(Model model) {
  switch (model) {
    case Model::kSpatial:
    case Model::kCompliant:
    case Model::kFiniteDuration:
      return false;
    case Model::kUnspecified:
    case Model::kNone:
    case Model::kFrictionless:
    case Model::kFirstOrder:
    case Model::kSliding:
    case Model::kPendulum:
    case Model::kPlanar:
    case Model::kImpactLaw:
      break;
  }
  return true;
}

// Says how the rounding errors of an impact are kept small. The numbers are those of ricochet.v1.Arithmetic.
enum class Arithmetic {
  kUnspecified = 0,
  kPlain = 1,  // Doubles, with a proved bound on the rounding error; no sign is taken that rounding may have changed.
  kCompensated = 2,  // Double-double: numbers of twice the precision, rounded to doubles at the end.
  kCertified = 3,    // Intervals of any precision, with each digit proved.
};

// Says why an impact was computed in its arithmetic. The numbers are those of ricochet.v1.PlannedArithmetic.Reason.
enum class ArithmeticReason {
  kUnspecified = 0,
  kWithinTolerance = 1,  // Plain arithmetic: its bound is within the part of the tolerance that effects leave.
  kZeroTolerance = 2,    // Compensated arithmetic: nothing is left of the tolerance.
  // Compensated arithmetic: plain arithmetic cannot prove a sign that decides on the regime, the order of the events or
  // a broken limit, or a number is beyond its range.
  kSignNotProved = 3,
  kBoundTooLarge = 4,  // Compensated arithmetic: the bound of plain arithmetic exceeds what is left of the tolerance.
  kOnlyOne = 5,        // The model has no other arithmetic.
};

struct PlannedArithmetic {
  Arithmetic arithmetic = Arithmetic::kUnspecified;
  ArithmeticReason reason = ArithmeticReason::kUnspecified;
  // Bounds the rounding error (docs/theory/rounding.md); absent for kOnlyOne, where Accuracy::relative_error alone
  // knows.
  std::optional<double> rounding_error;
  friend bool operator==(const PlannedArithmetic&, const PlannedArithmetic&) = default;
};

struct Plan {
  Model model = Model::kUnspecified;
  double relative_tolerance = 0.0;  // Tolerance asked for.
  double neglected = 0.0;           // Sum of the sizes of all effects left out; bounds what they change together.
  PlannedEffects effects;
  PlannedArithmetic arithmetic;
  friend bool operator==(const Plan&, const Plan&) = default;
};

inline std::vector<PlannedEffect> PlannedEffects::List() const {
  if (written_ != nullptr) return *written_;
  std::vector<PlannedEffect> effects;
  for (int number = 1; author_ != nullptr && number < kEffectCount; ++number) {
    const Fact& fact = facts_[static_cast<size_t>(number)];
    const auto effect = static_cast<Effect>(number);
    effects.push_back({effect, fact.decision, fact.size, author_(effect, facts_)});
  }
  return effects;
}

}  // namespace ricochet

#endif  // RICOCHET_PLAN_H_
