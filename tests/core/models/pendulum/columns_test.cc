// Columns have the bits of single impacts, whatever is asked for and whichever problems stand beside them.

#include "core/models/pendulum/columns.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <memory>
#include <set>
#include <vector>

#include "core/models/pendulum/pendulum.h"
#include "core/models/restitution_law.h"
#include "hwy/targets.h"
#include "tests/support/only_target.h"
#include "tests/support/oracles/pendulum_oracle.h"
#include "tests/support/scenes/pendulum_scenes.h"
#include "tests/support/scenes/solved_in_lanes.h"

namespace ricochet::pendulum {
namespace {

// The impact by the first arithmetic whose bound is within the tolerance.
Impact SolveWithin(double tolerance, const Problem& problem) {
  const PlainImpact plain = SolvePlain(problem);
  return plain.proved && plain.relative_error <= tolerance ? plain.impact : Solve(problem);
}

// Every output by itself, some of them, and all.
std::vector<std::vector<Output>> Selections() {
  std::vector<std::vector<Output>> selections;
  for (int i = 0; i < kOutputCount; ++i) selections.push_back({static_cast<Output>(i)});
  selections.push_back({Output::kEnergyChange, Output::kNewton, Output::kTangentialImpulse});
  std::vector<Output>& all = selections.emplace_back();
  for (int i = 0; i < kOutputCount; ++i) all.push_back(static_cast<Output>(i));
  return selections;
}

TEST(PendulumColumnsTest, AnySelectionOfOutputsHasTheBitsOfSolveAtAnyTolerance) {
  SceneSource source(64);
  std::vector<Problem> problems;
  for (int i = 0; i < 5'000; ++i) problems.push_back(i < 1'000 ? source.Everyday() : source.Any());
  for (const double tolerance : {0.0, 20.0 * 0x1p-53, 1e-12}) {
    std::vector<Impact> impacts;
    for (const Problem& problem : problems) impacts.push_back(SolveWithin(tolerance, problem));
    for (const std::vector<Output>& outputs : Selections()) {
      const SolvedInLanes solved = SolveInLanes(problems, outputs, tolerance);
      for (size_t i = 0; i < problems.size(); ++i) {
        const Impact& impact = impacts[i];
        for (size_t c = 0; c < outputs.size(); ++c) {
          ASSERT_EQ(std::bit_cast<uint64_t>(solved.columns[c][i]), std::bit_cast<uint64_t>(impact[outputs[c]]))
              << OutputNames()[static_cast<size_t>(outputs[c])] << " at " << ToString(problems[i]);
        }
        ASSERT_EQ(solved.regimes[i], impact.regime);
        ASSERT_EQ(solved.inadmissible[i], impact.sharp_limit_broken || impact.energy_limit_broken)
            << ToString(problems[i]);
      }
    }
  }
}

TEST(PendulumColumnsTest, AnyPartOfTheProblemsHasTheBitsOfAll) {
  constexpr size_t kCount = 200;
  SceneSource source(65);
  ProblemColumns problems(RestitutionLaw::kNewton, kCount);
  for (size_t i = 0; i < kCount; ++i) {
    Problem problem = source.Any();
    problem.law = RestitutionLaw::kNewton;
    problems.Set(i, problem);
  }
  const std::vector<Output> outputs = {Output::kTangentialImpulse};
  const auto solve = [&](size_t first, size_t count) {
    std::vector<double> impulses(count);
    std::vector<double*> columns = {impulses.data()};
    std::vector<Regime> regimes(count);
    const auto inadmissible = std::make_unique<bool[]>(count);
    SolveColumns(problems, first, count, 1e-12,
                 {.outputs = outputs,
                  .columns = columns,
                  .regimes = absl::MakeSpan(regimes),
                  .inadmissible = {inadmissible.get(), count}});
    return impulses;
  };
  const std::vector<double> all = solve(0, kCount);
  for (const size_t first : {size_t{1}, size_t{63}, size_t{100}}) {
    for (const size_t count : {size_t{1}, size_t{9}, size_t{70}}) {
      const std::vector<double> part = solve(first, count);
      for (size_t i = 0; i < count; ++i) {
        ASSERT_EQ(std::bit_cast<uint64_t>(part[i]), std::bit_cast<uint64_t>(all[first + i])) << first + i;
      }
    }
  }
}

// Hard problems stand at the ends of blocks and vectors, alone and in a row. Their bound is above 1e-12, because they
// are close to locking; that of all others is below.
TEST(PendulumColumnsTest, OnlyProblemsWhoseBoundFailsAreSolvedOnceMoreOnEveryTarget) {
  constexpr size_t kCount = 300;
  constexpr double kTolerance = 1e-12;
  const std::set<size_t> hard = {0, 3, 7, 8, 9, 63, 64, 65, 100, 127, 200, 201, 202, 203, 204, 205, 206, 207, 299};
  SceneSource source(66);
  std::vector<Problem> problems;
  while (problems.size() < kCount) {
    Problem problem = source.Everyday();
    problem.b = 0.2 * problem.a;
    problem.mu = problem.mu_static = hard.contains(problems.size()) ? 5.0 * (1.0 - 1e-9) : source.Uniform(0.0, 4.0);
    problem.law = RestitutionLaw::kEnergetic;
    problem.coefficient = source.Uniform(0.5, 1.0);
    problems.push_back(problem);
  }
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    const OnlyTarget only(target);
    const SolvedInLanes solved = SolveInLanes(problems, {Output::kPoisson, Output::kEnergyChange}, kTolerance);
    size_t differing = 0;
    for (size_t i = 0; i < kCount; ++i) {
      const PlainImpact plain = SolvePlain(problems[i]);
      const Impact compensated = Solve(problems[i]);
      ASSERT_EQ(plain.relative_error > kTolerance, hard.contains(i)) << i;
      const Impact& expected = hard.contains(i) ? compensated : plain.impact;
      ASSERT_EQ(solved.columns[0][i], expected[Output::kPoisson]) << i << " " << hwy::TargetName(target);
      ASSERT_EQ(solved.columns[1][i], expected[Output::kEnergyChange]) << i << " " << hwy::TargetName(target);
      ASSERT_EQ(solved.regimes[i], Regime::kRebound);
      if (plain.impact[Output::kPoisson] != compensated[Output::kPoisson]) ++differing;
    }
    EXPECT_GT(differing, kCount / 4);  // The bits tell the arithmetics apart.
  }
}

TEST(PendulumColumnsTest, NoProblemsAndNoOutputsAreFine) {
  SolveColumns(ProblemColumns(), 0, 0, 1e-12, {});
  for (const double tolerance : {0.0, 1e-12}) {
    const SolvedInLanes solved = SolveInLanes(
        {{.inertia = 2.0, .a = 1.0, .b = 1.0, .omega_minus = -3.0, .mu = 0.5, .mu_static = 0.5}}, {}, tolerance);
    EXPECT_EQ(solved.regimes[0], Regime::kRebound);
    EXPECT_FALSE(solved.inadmissible[0]);
  }
}

}  // namespace
}  // namespace ricochet::pendulum
