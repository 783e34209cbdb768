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
void AddFrictionless(const sliding::Problem<kTangential>& problem, const Choice& without, Methods& methods) {
  if (without.model != Model::kFrictionless) return;
  methods.push_back(
      {.name = "frictionless",
       .method = {.model = Model::kFrictionless, .arithmetic = Arithmetic::kPlain},
       .kernel = MakeSlidingKernel(problem, without.one_piece_errors.velocity, sliding::SolveFrictionless<kTangential>),
       .claimed_modelling = without.neglected,
       .exact = MakeReference([problem](Stopped) { return ExactFrictionless(problem); })});
}

template <size_t kTangential>
void AddSliding(const sliding::Problem<kTangential>& problem, const Choice& without, Methods& methods) {
  if (without.model != Model::kSliding) return;
  methods.push_back(
      {.name = "sliding",
       .method = {.model = Model::kSliding, .arithmetic = Arithmetic::kPlain},
       .kernel = MakeSlidingKernel(problem, without.one_piece_errors.velocity, sliding::Solve<kTangential>),
       .claimed_modelling = without.neglected,
       .exact = MakeReference([problem](Stopped) { return ExactSliding(problem); })});
}

template void AddFrictionless(const sliding::Problem<1>&, const Choice&, Methods&);
template void AddFrictionless(const sliding::Problem<2>&, const Choice&, Methods&);
template void AddSliding(const sliding::Problem<1>&, const Choice&, Methods&);
template void AddSliding(const sliding::Problem<2>&, const Choice&, Methods&);

}  // namespace ricochet
