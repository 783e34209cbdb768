// The spatial model at tolerances from 1e-2 to 1e-12, or at the last alone where the path takes no steps.

#include <iterator>

#include "absl/strings/str_cat.h"
#include "core/cost/methods_by_model.h"

namespace ricochet {
namespace {

using spatial::Problem;

constexpr double kTolerances[] = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12};

Kernel SpatialKernel(const Problem& problem) {
  const auto solve = [](const Problem& of, Stopped) { return spatial::Solve(of); };
  const auto read = [](const Problem&, const spatial::Impact& impact) {
    if (!impact.Converged()) return KernelAnswer{.failure = "The path in space could not be followed to its end."};
    return KernelAnswer{.velocity = {impact.u1[0], impact.u1[1], impact.v1},
                        .claimed = impact.error_estimate,
                        .steps = impact.steps,
                        .right_hand_sides = impact.right_hand_sides};
  };
  return MakeKernel(problem, solve, read);
}

}  // namespace

void AddSpatial(const Problem& problem, const ReferencePointer& exact, Methods& methods) {
  Problem coarse = problem;
  coarse.tolerance = *std::begin(kTolerances);
  const bool is_straight = spatial::Solve(coarse).steps == 0;
  for (const double tolerance : kTolerances) {
    if (is_straight && tolerance != *std::rbegin(kTolerances)) continue;
    Problem at = problem;
    at.tolerance = tolerance;
    methods.push_back({.name = absl::StrCat("space ", tolerance),
                       .method = {.model = Model::kSpatial, .arithmetic = Arithmetic::kPlain, .tolerance = tolerance},
                       .kernel = SpatialKernel(at),
                       .exact = exact});
  }
}

}  // namespace ricochet
