// All SIMD targets that this machine can run give the same bits.

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "core/models/pendulum/pendulum.h"
#include "hwy/targets.h"
#include "tests/support/only_target.h"
#include "tests/support/scenes/pendulum_scenes.h"
#include "tests/support/scenes/solved_in_lanes.h"

namespace ricochet::pendulum {
namespace {

std::vector<Problem> MixedProblems() {
  SceneSource source(1);
  std::vector<Problem> problems;
  for (int i = 0; i < 20'000; ++i) problems.push_back(i % 3 == 0 ? source.Any() : source.Everyday());
  return problems;
}

void Add(const Impact& impact, std::vector<uint64_t>& bits) {
  for (const double value : impact.values) bits.push_back(std::bit_cast<uint64_t>(value));
}

std::vector<uint64_t> BitsOfSolve(const std::vector<Problem>& problems) {
  std::vector<uint64_t> bits;
  for (const Problem& problem : problems) Add(Solve(problem), bits);
  return bits;
}

// At a tolerance that plain arithmetic meets for most of the problems.
constexpr double kTolerance = 1e-12;

std::vector<uint64_t> BitsOfPlainOrSolve(const std::vector<Problem>& problems) {
  std::vector<uint64_t> bits;
  for (const Problem& problem : problems) {
    const PlainImpact plain = SolvePlain(problem);
    Add(plain.proved && plain.relative_error <= kTolerance ? plain.impact : Solve(problem), bits);
  }
  return bits;
}

// The bits are in the order of BitsOfSolve.
std::vector<uint64_t> BitsOfSolveColumns(const std::vector<Problem>& problems, double tolerance) {
  std::vector<Output> outputs;
  for (int i = 0; i < kOutputCount; ++i) outputs.push_back(static_cast<Output>(i));
  const SolvedInLanes solved = SolveInLanes(problems, outputs, tolerance);
  std::vector<uint64_t> bits;
  for (size_t i = 0; i < problems.size(); ++i) {
    for (const std::vector<double>& column : solved.columns) bits.push_back(std::bit_cast<uint64_t>(column[i]));
  }
  return bits;
}

TEST(PendulumTargetsTest, EveryTargetGivesTheSameBits) {
  const std::vector<Problem> problems = MixedProblems();
  const std::vector<uint64_t> expected = BitsOfSolve(problems);
  const std::vector<uint64_t> expected_within = BitsOfPlainOrSolve(problems);
  EXPECT_FALSE(expected_within == expected);
  std::string names;
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    const OnlyTarget only(target);
    names += std::string(names.empty() ? "" : " ") + hwy::TargetName(target);
    EXPECT_TRUE(BitsOfSolve(problems) == expected) << hwy::TargetName(target);
    EXPECT_TRUE(BitsOfPlainOrSolve(problems) == expected_within) << hwy::TargetName(target);
    EXPECT_TRUE(BitsOfSolveColumns(problems, 0.0) == expected) << hwy::TargetName(target);
    EXPECT_TRUE(BitsOfSolveColumns(problems, kTolerance) == expected_within) << hwy::TargetName(target);
  }
  RecordProperty("targets", names);
}

}  // namespace
}  // namespace ricochet::pendulum
