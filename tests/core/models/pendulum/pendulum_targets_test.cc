// All SIMD targets that this machine can run give the same bits.

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/models/pendulum/pendulum.h"
#include "hwy/targets.h"
#include "tests/support/only_target.h"
#include "tests/support/pendulum_scenes.h"

namespace ricochet::pendulum {
namespace {

std::vector<Problem> MixedProblems() {
  SceneSource source(1);
  std::vector<Problem> problems;
  for (int i = 0; i < 20'000; ++i) problems.push_back(i % 3 == 0 ? source.Any() : source.Everyday());
  return problems;
}

std::vector<uint64_t> BitsOfSolve(const std::vector<Problem>& problems) {
  std::vector<uint64_t> bits;
  for (const Problem& problem : problems) {
    for (const double value : Solve(problem).values) bits.push_back(std::bit_cast<uint64_t>(value));
  }
  return bits;
}

// The names are in the order of BitsOfSolve.
std::vector<uint64_t> BitsOfSolveColumns(const std::vector<Problem>& problems) {
  std::vector<Output> outputs;
  std::vector<std::vector<double>> values(kOutputCount, std::vector<double>(problems.size()));
  std::vector<double*> columns;
  for (int i = 0; i < kOutputCount; ++i) {
    outputs.push_back(static_cast<Output>(i));
    columns.push_back(values[static_cast<size_t>(i)].data());
  }
  std::vector<Regime> regimes(problems.size());
  const auto inadmissible = std::make_unique<bool[]>(problems.size());
  SolveColumns(problems, outputs, columns, absl::MakeSpan(regimes), {inadmissible.get(), problems.size()});
  std::vector<uint64_t> bits;
  for (size_t i = 0; i < problems.size(); ++i) {
    for (const std::vector<double>& column : values) bits.push_back(std::bit_cast<uint64_t>(column[i]));
  }
  return bits;
}

TEST(PendulumTargetsTest, EveryTargetGivesTheSameBits) {
  const std::vector<Problem> problems = MixedProblems();
  const std::vector<uint64_t> expected = BitsOfSolve(problems);
  std::string names;
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    const OnlyTarget only(target);
    names += std::string(names.empty() ? "" : " ") + hwy::TargetName(target);
    EXPECT_TRUE(BitsOfSolve(problems) == expected) << hwy::TargetName(target);
    EXPECT_TRUE(BitsOfSolveColumns(problems) == expected) << hwy::TargetName(target);
  }
  RecordProperty("targets", names);
}

}  // namespace
}  // namespace ricochet::pendulum
