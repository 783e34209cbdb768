// Plan: which effects an impact was computed with, which were left out, why, and what that can change.
//
// core/plan/sizes.h proves the size of each effect, core/plan/choose.h takes the cheapest model within a demand
// (core/plan/demand.h), core/plan/explain.h says why. Sizes add up: `neglected` is the sum of those left out, and the
// answer is within that, and the model's own error, of the answer with all effects of the scene.

#ifndef RICOCHET_PLAN_H_
#define RICOCHET_PLAN_H_

#include <string>
#include <vector>

namespace ricochet {

// What may matter in an impact. The numbers are those of ricochet.v1.Effect.
enum class Effect {
  kUnspecified = 0,
  kFriction = 1,
  kSlipStop = 2,              // Slip that comes to rest, to stick or to reverse.
  kSlipTurn = 3,              // Slip that turns, in space.
  kStaticFriction = 4,        // A coefficient of static friction above the kinetic one.
  kTangentialCompliance = 5,  // A contact that gives way along the surface.
  kFiniteDuration = 6,        // An indentation that takes time.
  kFiniteForces = 7,          // Gravity and the like, at work during the contact.
  kHigherOrder = 8,           // What lies beyond first order in x = mu |b|/a, of a pendulum.
};
inline constexpr int kEffectCount = 9;

// The numbers are those of ricochet.v1.PlannedEffect.Decision.
enum class Decision {
  kUnspecified = 0,
  kAbsent = 1,  // The scene has it not, or it provably never comes into play.
  kSimulated = 2,
  kNegligible = 3,  // Left out: what all such can change together is within the tolerance.
  kRequired = 4,    // Simulated because the caller says so.
  kExcluded = 5,    // Left out because the caller says so, whatever that changes.
};

struct PlannedEffect {
  Effect effect = Effect::kUnspecified;
  Decision decision = Decision::kUnspecified;
  // The most that leaving it out changes in any contact velocity, or in an impulse times its mobility (Wnn tau, Wtt f;
  // in space (W11 + W22) |f|), over max(|u0|, |v0|). 0 where absent, and for what friction does where friction itself
  // is left out; infinite where no bound is known.
  double size = 0.0;
  std::string reason;  // One sentence: where the size comes from, with its numbers.
  friend bool operator==(const PlannedEffect&, const PlannedEffect&) = default;
};

// The numbers are those of ricochet.v1.Model.
enum class Model {
  kUnspecified = 0,
  kNone = 1,            // The contact separates: nothing to compute.
  kFrictionless = 2,    // core/models/sliding/sliding.h without friction
  kFirstOrder = 3,      // core/models/pendulum/first_order.h
  kSliding = 4,         // core/models/sliding/sliding.h
  kPendulum = 5,        // core/models/pendulum/pendulum.h
  kPlanar = 6,          // core/models/planar/planar.h
  kSpatial = 7,         // core/models/spatial/spatial.h
  kCompliant = 8,       // core/models/compliant/compliant.h
  kFiniteDuration = 9,  // core/models/finite_duration/finite_duration.h
  kImpactLaw = 10,      // core/models/laws/impact_laws.h
};
inline constexpr int kModelCount = 11;

struct Plan {
  Model model = Model::kUnspecified;
  double relative_tolerance = 0.0;     // As asked for.
  double neglected = 0.0;              // What all effects left out can change together: the sum of their sizes.
  std::vector<PlannedEffect> effects;  // Every effect once, in order of their numbers.
  friend bool operator==(const Plan&, const Plan&) = default;
};

}  // namespace ricochet

#endif  // RICOCHET_PLAN_H_
