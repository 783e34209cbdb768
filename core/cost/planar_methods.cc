// The methods of a contact in a plane whose impact takes no time: the planar model in plain and compensated arithmetic,
// tangential compliance, and impact laws.

#include <utility>

#include "core/answer/outcome_parts.h"
#include "core/cost/methods_by_model.h"
#include "core/models/compliant/compliant.h"
#include "core/models/laws/impact_law.h"

namespace ricochet {
namespace {

using planar::Problem;

Kernel PlainKernel(const Problem& problem) {
  const auto solve = [](const Problem& of, Stopped) { return planar::SolvePlain(of); };
  const auto read = [](const Problem&, const planar::PlainImpact& plain) {
    if (!plain.proved) return KernelAnswer{.failure = kNotProved};
    return KernelAnswer{.velocity = {plain.impact.u1, 0.0, plain.impact.v1}, .claimed = plain.errors.velocity};
  };
  return MakeKernel(problem, solve, read);
}

Kernel CompensatedKernel(const Problem& problem) {
  struct Bounded {
    planar::Impact impact;
    planar::RoundingErrors errors;
  };
  const auto solve = [](const Problem& of, Stopped) {
    Bounded bounded;
    bounded.impact = planar::Solve(of, bounded.errors);
    return bounded;
  };
  const auto read = [](const Problem&, const Bounded& bounded) {
    return KernelAnswer{.velocity = {bounded.impact.u1, 0.0, bounded.impact.v1}, .claimed = bounded.errors.velocity};
  };
  return MakeKernel(problem, solve, read);
}

}  // namespace

void AddPlanar(const Problem& problem, const ContactPhysics& physics, const ReferencePointer& exact,
               double reduction_error, Methods& methods) {
  const double neglected = NeglectedBy(Model::kPlanar, problem, physics);
  const auto add = [&](Arithmetic arithmetic, Kernel kernel) {
    methods.push_back({.name = "planar, " + NameOf(arithmetic),
                       .method = {.model = Model::kPlanar, .arithmetic = arithmetic},
                       .kernel = std::move(kernel),
                       .claimed_modelling = neglected,
                       .claimed_reduction = reduction_error,
                       .exact = exact});
  };
  add(Arithmetic::kPlain, PlainKernel(problem));
  add(Arithmetic::kCompensated, CompensatedKernel(problem));
}

double NeglectedBy(Model model, const Problem& problem, const ContactPhysics& physics) {
  if (!(problem.v0 < 0.0)) return 0.0;
  const Choice choice = ChoosePlanar(problem, physics, DemandFor(model));
  return choice.model == Model::kUnspecified ? kNotKnown : choice.neglected;
}

ReferencePointer AddCompliant(const Problem& problem, const ContactPhysics& physics, Methods& methods) {
  const compliant::Problem compliance = {.contact = problem, .ratio_squared = physics.ratio_squared};
  const auto solve = [](const compliant::Problem& of, Stopped) { return compliant::Solve(of); };
  const auto read = [](const compliant::Problem&, const compliant::Impact& impact) {
    if (!impact.Converged()) return KernelAnswer{.failure = "The impact has not ended after the most sections."};
    return KernelAnswer{.velocity = {impact.u1, 0.0, impact.v1}, .claimed = impact.error_estimate};
  };
  ReferencePointer exact = MakeReference([compliance](Stopped) {
    const compliant::Impact impact = compliant::Solve(compliance);
    return ReferenceAt({impact.u1, 0.0, impact.v1}, impact.error_estimate,
                       "the model of tangential compliance itself, with the error that it estimates");
  });
  methods.push_back({.name = "tangential compliance",
                     .method = {.model = Model::kCompliant, .arithmetic = Arithmetic::kPlain},
                     .kernel = MakeKernel(compliance, solve, read),
                     .claimed_modelling = NeglectedBy(Model::kCompliant, problem, physics),
                     .exact = exact,
                     .note = "This model is its own reference: its numerical error is known by its estimate alone."});
  return exact;
}

void AddImpactLaw(const ImpactLaw& law, const Problem& problem, Methods& methods) {
  const auto solve = [law](const Problem& of, Stopped) { return laws::SolveLaw(law, of); };
  const auto read = [law](const Problem& of, const laws::ImpactLawResult& result) {
    if (result.solutions.empty()) return KernelAnswer{.failure = "The law has no solution for this contact."};
    const laws::ImpactSolution& first = result.solutions.front();
    return KernelAnswer{.velocity = {first.u1, 0.0, first.v1}, .claimed = laws::RelativeErrorOf(law, of, first)};
  };
  methods.push_back({.name = "impact law",
                     .method = {.model = Model::kImpactLaw, .arithmetic = Arithmetic::kPlain},
                     .kernel = MakeKernel(problem, solve, read),
                     .note = "An impact law has no reference to find its error with."});
}

}  // namespace ricochet
