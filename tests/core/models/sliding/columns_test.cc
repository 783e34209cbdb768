// Columns of straight paths have the bits of single impacts on every SIMD target, whatever is asked for and wherever a
// problem stands.

#include "core/models/sliding/columns.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/models/sliding/sliding.h"
#include "hwy/targets.h"
#include "tests/support/only_target.h"
#include "tests/support/scenes/planar_scenes.h"
#include "tests/support/scenes/solved_in_lanes.h"

namespace ricochet::sliding {
namespace {

using planar::PlanarColumnsOfLaw;

constexpr int kOutputs = kPlanarOutputCount - 1;  // All but the relative error.

std::array<double, kOutputs> NumbersOf(const Impact<1>& x) {
  const double tangential = x.work_tangential_compression + x.work_tangential_restitution;
  return {x.newton,
          x.poisson,
          x.energetic,
          x.tangential,
          x.u1[0],
          x.v1,
          x.tau_compression,
          x.tau1,
          x.f1[0],
          x.work_normal_compression,
          x.work_normal_restitution,
          x.work_tangential_compression,
          x.work_tangential_restitution,
          x.work_normal_compression + x.work_normal_restitution,
          tangential,
          0.0 - tangential,
          x.energy_change};
}

// Problems that slide, some of them so far that friction drives slip backwards and breaks the limit of energy.
std::vector<PlanarProblem> SlidingProblems(int count) {
  planar::SceneSource source(7);
  std::vector<PlanarProblem> problems;
  while (problems.size() < static_cast<size_t>(count)) {
    PlanarProblem problem = source.Everyday();
    if (problem.mu == 0.0 || problem.coefficient > 1.0 || problem.mu * std::fabs(problem.w.tn) >= problem.w.nn)
      continue;
    problem.law = RestitutionLaw::kEnergetic;
    problems.push_back(problem);
  }
  return problems;
}

struct Case {
  Impact<1> (*solve)(const Problem<1>&);
  void (*solve_columns)(const PlanarProblemColumns&, const PlanarSolvedColumns&);
  Regime regime;
};

class SlidingColumns : public testing::TestWithParam<Case> {};

INSTANTIATE_TEST_SUITE_P(Models, SlidingColumns,
                         testing::Values(Case{&Solve<1>, &SolveColumns, Regime::kSliding},
                                         Case{&SolveFrictionless<1>, &SolveFrictionlessColumns,
                                              Regime::kFrictionless}));

// Compares the problems [first, end) in lanes with single impacts, in the outputs asked for. Returns how many break a
// limit.
int Compare(const Case& of, const std::vector<PlanarProblem>& problems, size_t first,
            const std::vector<PlanarOutput>& outputs) {
  PlanarColumnsOfLaw columns = {.law = RestitutionLaw::kEnergetic};
  for (const PlanarProblem& problem : problems) columns.Add(problem);
  const size_t count = problems.size() - first;
  std::vector<std::vector<double>> values(outputs.size(), std::vector<double>(count));
  std::vector<double*> places;
  for (auto& column : values) places.push_back(column.data());
  std::vector<Regime> regimes(count);
  const auto inadmissible = std::make_unique<bool[]>(count);
  of.solve_columns(columns.Columns(first, count), {.outputs = outputs,
                                                   .columns = places,
                                                   .regimes = absl::MakeSpan(regimes),
                                                   .inadmissible = {inadmissible.get(), count}});
  int broken = 0;
  for (size_t i = 0; i < count; ++i) {
    const PlanarProblem& p = problems[first + i];
    const Impact<1> impact =
        of.solve({.w = {p.w.tt, p.w.tn, p.w.nn}, .u0 = {p.u0}, .v0 = p.v0, .mu = p.mu, .coefficient = p.coefficient});
    EXPECT_EQ(regimes[i], impact.regime);
    EXPECT_EQ(regimes[i], of.regime);
    EXPECT_EQ(inadmissible[i], impact.sharp_limit_broken || impact.energy_limit_broken) << i;
    broken += inadmissible[i] ? 1 : 0;
    const std::array<double, kOutputs> numbers = NumbersOf(impact);
    for (size_t c = 0; c < outputs.size(); ++c) {
      EXPECT_EQ(std::bit_cast<uint64_t>(values[c][i]),
                std::bit_cast<uint64_t>(numbers[static_cast<size_t>(outputs[c])]))
          << "output " << static_cast<int>(outputs[c]) << " of problem " << i;
    }
  }
  return broken;
}

TEST_P(SlidingColumns, HaveTheBitsOfSingleImpactsOnEverySimdTarget) {
  std::vector<PlanarOutput> all;
  for (int i = 0; i < kOutputs; ++i) all.push_back(static_cast<PlanarOutput>(i));
  const std::vector<PlanarProblem> problems = SlidingProblems(1001);
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    const OnlyTarget only(target);
    int broken = 0;
    for (const size_t first : {size_t{0}, size_t{3}, size_t{996}, size_t{1000}}) {
      broken += Compare(GetParam(), problems, first, all);
      Compare(GetParam(), problems, first, {PlanarOutput::kEnergyChange, PlanarOutput::kNormalVelocityAfter});
    }
    EXPECT_EQ(broken > 10, GetParam().regime == Regime::kSliding) << broken;
  }
}

}  // namespace
}  // namespace ricochet::sliding
