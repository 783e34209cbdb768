// Columns have the bits of single impacts on every SIMD target, whichever problems stand beside them.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <set>
#include <vector>

#include "core/models/spatial/columns.h"
#include "core/models/spatial/spatial.h"
#include "hwy/targets.h"
#include "tests/support/only_target.h"
#include "tests/support/scenes/spatial_scenes.h"

namespace ricochet::spatial {
namespace {

void AddBits(const std::array<double, 2>& pair, std::vector<uint64_t>& bits) {
  for (const double number : pair) bits.push_back(std::bit_cast<uint64_t>(number));
}

void AddBits(const Instant& instant, std::vector<uint64_t>& bits) {
  bits.push_back(static_cast<uint64_t>(instant.kind));
  AddBits(instant.f, bits);
  AddBits(instant.u, bits);
  AddBits({instant.tau, instant.v}, bits);
}

// Everything that an impact says.
std::vector<uint64_t> BitsOf(const Impact& impact) {
  std::vector<uint64_t> bits = {static_cast<uint64_t>(impact.regime),
                                static_cast<uint64_t>(impact.termination),
                                static_cast<uint64_t>(impact.w_rank),
                                static_cast<uint64_t>(impact.sharp_limit_broken),
                                static_cast<uint64_t>(impact.energy_limit_broken),
                                static_cast<uint64_t>(impact.closed_form),
                                static_cast<uint64_t>(impact.steps),
                                static_cast<uint64_t>(impact.right_hand_sides),
                                static_cast<uint64_t>(impact.event_count)};
  AddBits(impact.u1, bits);
  AddBits(impact.f1, bits);
  for (const double number :
       {impact.newton, impact.poisson, impact.energetic, impact.tangential, impact.energetic_excess, impact.v1,
        impact.tau_compression, impact.tau1, impact.work_normal_compression, impact.work_normal_restitution,
        impact.work_tangential_compression, impact.work_tangential_restitution, impact.energy_change,
        impact.error_estimate}) {
    bits.push_back(std::bit_cast<uint64_t>(number));
  }
  for (int i = 0; i < impact.event_count; ++i) AddBits(impact.events[static_cast<size_t>(i)], bits);
  return bits;
}

// A W of rank two, whose third row is the sum of the first two times `share`, with a velocity in its range.
Problem OfRankTwo(SceneSource& source, double share) {
  Problem problem = source.Typical();
  problem.w13 = share * (problem.w11 + problem.w12);
  problem.w23 = share * (problem.w12 + problem.w22);
  problem.w33 = share * (problem.w13 + problem.w23);
  problem.v0 = share * (problem.u0[0] + problem.u0[1]);
  return problem;
}

// Slip along the second axis alone can be changed.
Problem WithSingularTangent(SceneSource& source) {
  Problem problem = source.Typical();
  problem.w11 = problem.w12 = problem.w13 = 0.0;
  problem.u0[0] = 0.0;
  return problem;
}

Problem AnyOf(SceneSource& source) {
  Problem problem = source.Typical();
  switch (source.Below(12)) {
    case 0:
      return OfRankTwo(source, source.Uniform(-2.0, 2.0));
    case 1:
      return WithSingularTangent(source);
    case 2:
      problem.mu = problem.mu_static = 0.0;
      return problem;
    case 3:
      problem.u0 = {};
      return problem;
    case 4:
      problem.mu_static = problem.mu * source.Uniform(1.0, 3.0);
      return problem;
    case 5:
      problem.v0 = -problem.v0;
      return problem;
    case 6:
      problem.coefficient = 0.0;
      return problem;
    case 7:
      problem.mu = problem.mu_static = source.Uniform(1.0, 5.0);
      return problem;
    case 8:
    case 9:
    case 10:
      return source.NearSingular();
    default:
      return problem;
  }
}

constexpr std::array kTolerances = {1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12};

// The tolerances come in runs, and within a run two of them alternate.
std::vector<Problem> MixedProblems(uint64_t seed, size_t count) {
  SceneSource source(seed);
  std::vector<Problem> problems(count);
  for (size_t i = 0; i < count; ++i) {
    problems[i] = AnyOf(source);
    problems[i].tolerance = kTolerances[(i / 1000 + (source.Below(8) == 0 ? 1 : 0)) % kTolerances.size()];
  }
  return problems;
}

std::vector<Impact> InColumns(const std::vector<Problem>& problems) {
  std::vector<Impact> impacts(problems.size());
  SolveColumns(problems, absl::MakeSpan(impacts));
  return impacts;
}

TEST(SpatialColumnsTest, ColumnsHaveTheBitsOfSingleImpactsOnEveryTarget) {
  const std::vector<Problem> problems = MixedProblems(81, 120'000);
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    const OnlyTarget only(target);
    SCOPED_TRACE(hwy::TargetName(target));
    const std::vector<Impact> impacts = InColumns(problems);
    for (size_t i = 0; i < problems.size(); ++i) {
      ASSERT_EQ(BitsOf(impacts[i]), BitsOf(Solve(problems[i]))) << "problem " << i;
    }
  }
}

// The test above relies on this.
TEST(SpatialColumnsTest, TheProblemsTakeEveryCourse) {
  std::set<Regime> regimes;
  int64_t attempts_with_steps = 0;
  int unsure = 0;
  for (const Problem& problem : MixedProblems(81, 20'000)) {
    const Impact impact = Solve(problem);
    regimes.insert(impact.regime);
    attempts_with_steps += impact.steps > 0 ? 1 : 0;
    unsure += impact.error_estimate > problem.tolerance ? 1 : 0;
  }
  for (const Regime regime :
       {Regime::kSeparating, Regime::kSliding, Regime::kStickInCompression, Regime::kStickInRestitution,
        Regime::kReversalInCompression, Regime::kReversalInRestitution, Regime::kFrictionless, Regime::kLocked}) {
    EXPECT_TRUE(regimes.contains(regime)) << static_cast<int>(regime);
  }
  EXPECT_GT(attempts_with_steps, 10'000);
  EXPECT_GT(unsure, 0);
}

TEST(SpatialColumnsTest, AnyPartOfTheProblemsHasTheBitsOfAll) {
  constexpr size_t kCount = 100;
  const std::vector<Problem> problems = MixedProblems(82, kCount);
  const std::vector<Impact> all = InColumns(problems);
  for (size_t first = 0; first < kCount; first += 7) {
    for (size_t count = 0; count <= std::min<size_t>(kCount - first, 20); ++count) {
      std::vector<Impact> part(count);
      SolveColumns(absl::MakeConstSpan(problems).subspan(first, count), absl::MakeSpan(part));
      for (size_t i = 0; i < count; ++i) ASSERT_EQ(BitsOf(part[i]), BitsOf(all[first + i])) << first + i;
    }
  }
}

}  // namespace
}  // namespace ricochet::spatial
