// The methods whose path is a straight line, in a plane and in space: without friction, and with slip that goes on.

#include "core/cost/methods_by_model.h"

namespace ricochet {
namespace {

template <size_t kTangential>
Kernel MakeSlidingKernel(const sliding::Problem<kTangential>& problem, double claimed,
                         sliding::Impact<kTangential> (*solve)(const sliding::Problem<kTangential>&)) {
  using Problem = sliding::Problem<kTangential>;
  const auto call = [solve](const Problem& of, Stopped) { return solve(of); };
  const auto read = [claimed](const Problem&, const sliding::Impact<kTangential>& impact) {
    return KernelAnswer{.velocity = {impact.u1[0], kTangential == 1 ? 0.0 : impact.u1.back(), impact.v1},
                        .claimed = claimed};
  };
  return MakeKernel(problem, call, read);
}

}  // namespace

template <size_t kTangential>
void AddStraight(Model model, const sliding::Problem<kTangential>& problem, const Choice& choice, Methods& methods) {
  if (choice.model != model) return;
  const bool slides = model == Model::kSliding;
  const auto solve = slides ? sliding::Solve<kTangential> : sliding::SolveFrictionless<kTangential>;
  sliding::Problem<kTangential> own = problem;
  if (!slides) own.mu = 0.0;
  methods.push_back({.name = slides ? "sliding" : "frictionless",
                     .method = {.model = model, .arithmetic = Arithmetic::kPlain},
                     .kernel = MakeSlidingKernel(problem, choice.one_piece_errors.velocity, solve),
                     .claimed_modelling = choice.neglected,
                     .exact = MakeReference([own](Stopped) { return ExactSliding(own); })});
}

template void AddStraight(Model, const sliding::Problem<1>&, const Choice&, Methods&);
template void AddStraight(Model, const sliding::Problem<2>&, const Choice&, Methods&);

}  // namespace ricochet
