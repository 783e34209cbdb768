#include "core/plan/choose.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <variant>

#include "absl/functional/function_ref.h"
#include "absl/types/span.h"
#include "core/models/pendulum/first_order.h"
#include "core/models/sliding/sliding.h"
#include "core/plan/candidates.h"
#include "core/plan/perturbed_path.h"
#include "core/plan/scene_problem.h"

namespace ricochet {
namespace {

// Any model leaves these effects out if the corresponding input is 0.
constexpr EffectSet kSwitched = {Effect::kFriction, Effect::kStaticFriction, Effect::kTangentialCompliance,
                                 Effect::kFiniteForces};

// The models of a contact in order of cost, and each one's own error over V: infinite if the model does not serve the
// contact. It is not asked for a model that leaves out too much.
struct Candidates {
  absl::Span<const Candidate> models;
  absl::FunctionRef<double(Model)> error;
};

struct Context {
  const Sizes& sizes;
  const Demand& demand;
  EffectSet excluded;  // Includes the effects that the caller's exclusions imply.

  // True if a model that simulates these effects may be used: it has every required effect, and every excluded effect
  // among them can be switched off.
  bool Allows(EffectSet simulates) const {
    EffectSet fixed = excluded.Without(kSwitched);
    if (excluded.Has(Effect::kFriction)) fixed = fixed.Without(kOnFriction);
    return simulates.Contains(demand.required) && (simulates & fixed).IsEmpty();
  }

  // True if friction is left out of a model that simulates these effects.
  bool IsSmooth(EffectSet simulates) const {
    return !simulates.Has(Effect::kFriction) || excluded.Has(Effect::kFriction);
  }

  // Sum of the sizes of the effects that a model leaves out and the caller does not exclude. It stops above the
  // tolerance.
  double Neglected(EffectSet simulates) const {
    const bool smooth = IsSmooth(simulates);
    EffectSet counted = simulates | excluded;
    if (smooth) counted = counted | kOnFriction;
    double sum = 0.0;
    for (const Effect effect : kEffects) {
      if (counted.Has(effect)) continue;
      sum += SizeOf(effect, smooth);
      if (sum > demand.relative_tolerance) break;
    }
    return sum;
  }

  double SizeOf(Effect effect, bool smooth) const {
    const bool beyond = smooth && effect == Effect::kFiniteForces && !excluded.Has(Effect::kFriction);
    return beyond ? sizes.forces_beyond_friction : sizes[effect].value;
  }

  Decision DecisionOn(Effect effect, const Size& size, EffectSet simulates) const {
    if (demand.required.Has(effect)) return Decision::kRequired;
    if (size.IsAbsent()) return Decision::kAbsent;
    if (excluded.Has(effect)) return Decision::kExcluded;
    return simulates.Has(effect) ? Decision::kSimulated : Decision::kNegligible;
  }
};

// The first candidate within the tolerance. There may be none if the caller excludes an effect that every exact model
// has; then the last candidate is taken that leaves out nothing else.
const Candidate* Cheapest(const Context& context, const Candidates& candidates) {
  const Candidate* fallback = nullptr;
  for (const Candidate& candidate : candidates.models) {
    if (!context.Allows(candidate.simulates)) continue;
    const double neglected = context.Neglected(candidate.simulates);
    if (!(neglected <= context.demand.relative_tolerance) && neglected != 0.0) continue;
    const double error = candidates.error(candidate.model);
    if (!(error < kUnbounded)) continue;
    if (neglected + error <= context.demand.relative_tolerance) return &candidate;
    if (neglected == 0.0) fallback = &candidate;
  }
  return fallback;
}

// Sets the decisions and what follows from them. The sizes are still those without the excluded effects.
void Decide(const Context& context, const Candidate& candidate, const Sizes& of_all, Choice& choice) {
  choice.model = candidate.model;
  const bool smooth = context.IsSmooth(candidate.simulates);
  for (const Effect effect : kEffects) {
    Size& size = choice.sizes[effect];
    if (context.excluded.Has(effect)) size = of_all[effect];
    const Decision decision = context.DecisionOn(effect, size, candidate.simulates);
    choice.decisions[static_cast<size_t>(effect)] = decision;
    if (decision != Decision::kNegligible && decision != Decision::kExcluded) continue;
    choice.left_out.Add(effect);
    if (decision == Decision::kNegligible) size.value = context.SizeOf(effect, smooth);
    // The size of friction covers this effect already.
    if (kOnFriction.Has(effect) && smooth) size.value = 0.0;
    choice.neglected += size.value;
    if (decision == Decision::kNegligible) choice.negligible += size.value;
  }
}

Choice ChooseAmong(const Sizes& sizes, const Sizes& of_all, const Demand& demand, EffectSet excluded,
                   const Candidates& candidates) {
  Choice choice = {.sizes = sizes};
  const Context context = {.sizes = sizes, .demand = demand, .excluded = excluded};
  const Candidate* candidate = Cheapest(context, candidates);
  if (candidate != nullptr) Decide(context, *candidate, of_all, choice);
  const double left = demand.relative_tolerance - choice.negligible;  // For the model's own error.
  if (choice.model == Model::kFiniteDuration) choice.model_tolerance = std::clamp(left, 1e-12, 1e-1);
  if (choice.model == Model::kSpatial) {
    choice.model_tolerance = std::clamp(left, spatial::kLeastTolerance, spatial::kMostTolerance);
  }
  return choice;
}

Choice Separating() {
  Choice choice;
  choice.model = Model::kNone;
  choice.decisions.fill(Decision::kAbsent);
  return choice;
}

bool HasForces(const ContactPhysics& physics) {
  return (physics.tangential_acceleration != 0.0 || physics.normal_acceleration != 0.0) &&
         !std::holds_alternative<std::monostate>(physics.spring);
}

bool IsOnePiece(const planar::Problem& problem) {
  const bool full_rank = std::fabs(problem.w.RelativeDeterminant()) > 0x1p-40;
  const double cone = problem.mu * std::fabs(problem.w.tn) / problem.w.nn;
  return problem.coefficient <= 1.0 && (full_rank || problem.w.tt == 0.0) && 1.0 - cone >= kLeastSlope;
}

// True if det W over the product of the diagonal is above 2^-40, far above its value for a W of less than full rank.
bool HasFullRank(const spatial::Problem& w) {
  const double c12 = w.w12 / std::sqrt(w.w11 * w.w22);
  const double c13 = w.w13 / std::sqrt(w.w11 * w.w33);
  const double c23 = w.w23 / std::sqrt(w.w22 * w.w33);
  return 1.0 + 2.0 * c12 * c13 * c23 - (c12 * c12 + c13 * c13 + c23 * c23) > 0x1p-40;
}

bool IsOnePiece(const spatial::Problem& problem) {
  const double coupling = std::sqrt(problem.w13 * problem.w13 + problem.w23 * problem.w23);
  return problem.coefficient <= 1.0 && HasFullRank(problem) && 1.0 - problem.mu * coupling / problem.w33 >= kLeastSlope;
}

// The errors of the two models whose path is a straight line, for a planar or spatial problem. Each is computed when
// it is asked for.
template <typename Problem>
class OnePieceErrors {
 public:
  OnePieceErrors(const Problem& problem, bool slips) : problem_(problem), slips_(slips) {}

  double Frictionless() {
    if (!IsOnePiece(problem_)) return kUnbounded;
    frictionless_ = sliding::FrictionlessErrorsOf(SlidingProblemOf(problem_));
    return frictionless_.Largest();
  }
  double Sliding() {
    if (!slips_ || !(problem_.mu > 0.0) || !IsOnePiece(problem_)) return kUnbounded;
    sliding_ = sliding::ErrorsOf(SlidingProblemOf(problem_));
    return sliding_.Largest();
  }
  void KeepThoseOf(Choice& choice) const {
    if (choice.model == Model::kFrictionless) choice.one_piece_errors = frictionless_;
    if (choice.model == Model::kSliding) choice.one_piece_errors = sliding_;
  }

 private:
  const Problem& problem_;
  bool slips_;
  RelativeErrors frictionless_;
  RelativeErrors sliding_;
};

// True if slip goes on beyond its stop, which the caller does not exclude, until friction does positive work.
template <typename Problem>
bool SlidesTooFar(const Problem& problem, const Sizes& sizes, EffectSet excluded) {
  if (sizes[Effect::kSlipStop].value == 0.0 || excluded.Has(Effect::kSlipStop)) return false;
  return sliding::FrictionPushes(SlidingProblemOf(problem));
}

// Returns 0 if the contact has the springs of a model beyond the rigid impact, whose error the plan does not count.
double ErrorBeyondRigid(Model model, const ContactPhysics& physics) {
  const bool applies = model == Model::kCompliant ? physics.ratio_squared > 0.0
                                                  : !std::holds_alternative<std::monostate>(physics.spring);
  return applies ? 0.0 : kUnbounded;
}

// The choice for a contact that does not approach but that finite forces may press together: only the model of finite
// duration can compute it.
Choice ForcedContact() {
  Choice choice = Separating();
  choice.model = Model::kFiniteDuration;
  choice.model_tolerance = 1e-12;
  choice.sizes[Effect::kFiniteDuration] = {.value = kUnbounded, .basis = Basis::kNoInequality};
  choice.sizes[Effect::kFiniteForces] = {.value = kUnbounded, .basis = Basis::kNoInequality};
  choice.decisions[static_cast<size_t>(Effect::kFiniteDuration)] = Decision::kSimulated;
  choice.decisions[static_cast<size_t>(Effect::kFiniteForces)] = Decision::kSimulated;
  return choice;
}

// The error of the frictionless model for a pendulum as a planar contact, whose W and velocities are rounded products
// of the pendulum's numbers.
double PendulumFrictionlessError(const pendulum::Problem& problem) {
  constexpr double kReduction = 0x1p-49;
  if (problem.coefficient > 1.0) return kUnbounded;
  return kReduction + sliding::FrictionlessErrorsOf(SlidingProblemOf(PlanarOf(problem))).Largest();
}

// Chooses for a contact that approaches. It has one return, so that the choice is made in place.
Choice ChooseApproaching(const planar::Problem& problem, const ContactPhysics& physics, const Demand& demand,
                         EffectSet excluded) {
  const planar::Problem kept = Without(excluded, problem);
  const Sizes of_all = PlanarSizes(problem, physics);
  OnePieceErrors errors(kept, kept.u0 != 0.0);
  const auto error = [&](Model model) {
    if (model == Model::kPlanar) return 0.0;
    if (model == Model::kFrictionless) return errors.Frictionless();
    if (model == Model::kSliding) return SlidesTooFar(kept, of_all, excluded) ? kUnbounded : errors.Sliding();
    return ErrorBeyondRigid(model, physics);
  };
  const auto choose = [&](const Sizes& sizes) {
    return ChooseAmong(sizes, of_all, demand, excluded, {kPlanarCandidates, error});
  };
  Choice choice = excluded.IsEmpty()
                      ? choose(of_all)
                      : choose(PlanarSizes(kept, Without(excluded, physics), excluded.Has(Effect::kSlipStop)));
  errors.KeepThoseOf(choice);
  return choice;
}

}  // namespace

ContactPhysics Without(EffectSet effects, ContactPhysics physics) {
  if (effects.Has(Effect::kTangentialCompliance)) physics.ratio_squared = 0.0;
  if (effects.Has(Effect::kFiniteForces)) physics.tangential_acceleration = physics.normal_acceleration = 0.0;
  return physics;
}

Choice ChoosePlanar(const planar::Problem& problem, const ContactPhysics& physics, const Demand& demand) {
  const EffectSet excluded = WithImplied(demand.excluded, /*in_space=*/false);
  if (problem.v0 >= 0.0) return HasForces(Without(excluded, physics)) ? ForcedContact() : Separating();
  return ChooseApproaching(problem, physics, demand, excluded);
}

Model ModelOfPendulum(const pendulum::Problem& problem, double tolerance) {
  if (problem.omega_minus >= 0.0) return Model::kNone;
  if (PendulumFrictionSize(problem).value != 0.0) return Model::kPendulum;
  return PendulumFrictionlessError(problem) <= tolerance ? Model::kFrictionless : Model::kPendulum;
}

Choice ChoosePendulum(const pendulum::Problem& problem, const ContactPhysics& physics, const Demand& demand) {
  const EffectSet excluded = WithImplied(demand.excluded, /*in_space=*/false);
  const ContactPhysics kept_physics = Without(excluded, physics);
  if (problem.omega_minus >= 0.0) return HasForces(kept_physics) ? ForcedContact() : Separating();
  const pendulum::Problem kept = Without(excluded, problem);
  const Sizes of_all = PendulumSizes(problem, physics);
  const auto error = [&](Model model) {
    if (model == Model::kPendulum) return 0.0;
    if (model == Model::kFrictionless) return PendulumFrictionlessError(kept);
    if (model == Model::kFirstOrder) return first_order::Serves(kept) ? 0.0 : kUnbounded;
    return ErrorBeyondRigid(model, physics);
  };
  const auto choose = [&](const Sizes& sizes) {
    const bool is_smooth = sizes[Effect::kFriction].value == 0.0;
    const absl::Span<const Candidate> models =
        is_smooth ? absl::MakeConstSpan(kSmoothPendulumCandidates) : absl::MakeConstSpan(kPendulumCandidates);
    return ChooseAmong(sizes, of_all, demand, excluded, {models, error});
  };
  return excluded.IsEmpty() ? choose(of_all) : choose(PendulumSizes(kept, kept_physics));
}

Choice ChooseSpatial(const spatial::Problem& problem, const Demand& demand) {
  if (problem.v0 >= 0.0) return Separating();
  const EffectSet excluded = WithImplied(demand.excluded, /*in_space=*/true);
  const spatial::Problem kept = Without(excluded, problem);
  const Sizes of_all = SpatialSizes(problem);
  const Sizes sizes = excluded.IsEmpty() ? of_all : SpatialSizes(kept);
  OnePieceErrors errors(kept, kept.u0[0] != 0.0 || kept.u0[1] != 0.0);
  const auto error = [&](Model model) {
    if (model == Model::kFrictionless) return errors.Frictionless();
    if (model == Model::kSliding) return SlidesTooFar(kept, of_all, excluded) ? kUnbounded : errors.Sliding();
    return 0.0;
  };
  Choice choice = ChooseAmong(sizes, of_all, demand, excluded, {kSpatialCandidates, error});
  errors.KeepThoseOf(choice);
  return choice;
}

}  // namespace ricochet
