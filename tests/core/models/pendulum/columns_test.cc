// Columns have the bits of single impacts, whatever is asked for and whichever problems stand beside them.

#include "core/models/pendulum/columns.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/models/pendulum/pendulum.h"
#include "core/models/restitution_law.h"
#include "tests/support/pendulum_oracle.h"
#include "tests/support/pendulum_scenes.h"
#include "tests/support/solved_in_lanes.h"

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
