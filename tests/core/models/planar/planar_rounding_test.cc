// The bounds on rounding errors that the planar model claims, in plain and in double-double arithmetic, and the signs
// that plain arithmetic proves, are held against an event-by-event simulation in ball arithmetic.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <utility>
#include <vector>

#include "core/models/planar/planar.h"
#include "core/models/restitution_law.h"
#include "hwy/targets.h"
#include "tests/support/claims/planar_claims.h"
#include "tests/support/only_target.h"
#include "tests/support/oracles/arb.h"
#include "tests/support/oracles/planar_oracle.h"
#include "tests/support/scenes/known_contacts.h"
#include "tests/support/scenes/planar_scenes.h"

namespace ricochet::planar {
namespace {

constexpr int kScenes = 10'000;

// Claims over errors reached, without the impacts that came out exact.
class Claims {
 public:
  void Add(double claimed, double reached) {
    if (reached > 0.0) ratios_.push_back(claimed / reached);
  }
  double Median() {
    std::sort(ratios_.begin(), ratios_.end());
    return ratios_[ratios_.size() / 2];
  }
  double Least() const { return *std::min_element(ratios_.begin(), ratios_.end()); }

 private:
  std::vector<double> ratios_;
};

// Collects the claims of one kind of arithmetic and fails at the first one that is broken.
class Ledger {
 public:
  void Add(const Problem& problem, const Impact& impact, const RoundingErrors& claimed, const ExactImpact& exact) {
    if (!AreFinite(impact)) return;
    const RoundingErrors reached = ErrorsReached(problem, impact, exact);
    ASSERT_GE(claimed.velocity, reached.velocity) << ToString(problem);
    ASSERT_GE(claimed.impulse, reached.impulse) << ToString(problem);
    ASSERT_GE(claimed.work, reached.work) << ToString(problem);
    velocity_.Add(claimed.velocity, reached.velocity);
    impulse_.Add(claimed.impulse, reached.impulse);
    work_.Add(claimed.work, reached.work);
    ++count_;
  }
  int count() const { return count_; }
  double MedianOfVelocity() { return velocity_.Median(); }
  void Print(const char* what) {
    std::printf(
        "  %s, claimed over reached, median (least): velocity %.3g (%.3g), impulse %.3g (%.3g), work %.3g (%.3g)\n",
        what, velocity_.Median(), velocity_.Least(), impulse_.Median(), impulse_.Least(), work_.Median(),
        work_.Least());
  }

 private:
  Claims velocity_, impulse_, work_;
  int count_ = 0;
};

void ExpectSameCourse(const Problem& problem, const Impact& impact, const ExactImpact& exact) {
  ASSERT_EQ(impact.regime, exact.regime) << ToString(problem);
  ASSERT_EQ(impact.w_rank, exact.w_rank) << ToString(problem);
  ASSERT_EQ(static_cast<size_t>(impact.event_count), exact.events.size()) << ToString(problem);
  for (size_t i = 0; i < exact.events.size(); ++i) ASSERT_EQ(impact.events[i].kind, exact.events[i].kind);
  // A coefficient of 0 restores nothing.
  if (problem.coefficient == 0.0 || impact.regime == Regime::kLocked) return;
  ASSERT_EQ(impact.sharp_limit_broken, exact.energetic > Ball(1.0)) << ToString(problem);
  ASSERT_EQ(impact.energy_limit_broken, exact.energy_change > Ball(0.0)) << ToString(problem);
}

struct Both {
  Ledger plain, compensated;
  int scenes = 0;

  void Add(const Problem& problem) {
    ++scenes;
    const ExactImpact exact = SolveExactly(problem);
    RoundingErrors errors;
    const Impact impact = Solve(problem, errors);
    compensated.Add(problem, impact, errors, exact);
    const PlainImpact plain_impact = SolvePlain(problem);
    if (!plain_impact.proved) return;
    ExpectSameCourse(problem, plain_impact.impact, exact);
    plain.Add(problem, plain_impact.impact, plain_impact.errors, exact);
  }
  void Print() {
    plain.Print("plain");
    compensated.Print("double-double");
    std::printf("  plain arithmetic proved %d of %d\n", plain.count(), scenes);
  }
};

TEST(PlanarRoundingTest, ClaimsHoldInTypicalScenes) {
  Both both;
  SceneSource source(11);
  for (int i = 0; i < kScenes && !testing::Test::HasFailure(); ++i) both.Add(source.Everyday());
  both.Print();
  EXPECT_GT(both.plain.count(), kScenes * 98 / 100);
  EXPECT_LE(both.compensated.MedianOfVelocity(), 10.0);
}

TEST(PlanarRoundingTest, ClaimsHoldNearThresholdsAndWhereWIsSingular) {
  Both both;
  SceneSource source(12);
  for (int i = 0; i < kScenes && !testing::Test::HasFailure(); ++i) both.Add(source.Any());
  both.Print();
  EXPECT_LE(both.compensated.MedianOfVelocity(), 10.0);
}

TEST(PlanarRoundingTest, ClaimsHoldWhereTheVelocityLiesBesideTheRangeOfW) {
  Both both;
  SceneSource source(20);
  for (int i = 0; i < kScenes && !testing::Test::HasFailure(); ++i) {
    const Problem problem = source.OffRange();
    if (Solve(problem).regime != Regime::kWedged) both.Add(problem);
  }
  both.Print();
  EXPECT_GT(both.plain.count(), kScenes / 4);
}

// The inputs lie within a factor of 1 +- 2^-20 ... 2^-52 of each threshold.
TEST(PlanarRoundingTest, ClaimsHoldNearEverySignChange) {
  Both both;
  SceneSource source(13);
  for (int i = 0; i < kScenes && !testing::Test::HasFailure(); ++i) {
    const auto change = static_cast<SceneSource::SignChange>(i % SceneSource::kSignChanges);
    both.Add(source.NearSignChange(change, source.NearlyOne()));
  }
  both.Print();
  EXPECT_GT(both.plain.count(), kScenes / 3);
}

// Velocities and W are scaled by up to 100 decades, and inputs are taken from the whole range of doubles.
TEST(PlanarRoundingTest, ClaimsHoldForScalesOf100Decades) {
  Both both;
  SceneSource source(14);
  for (int i = 0; i < kScenes / 5 && !testing::Test::HasFailure(); ++i) {
    const double scale = std::pow(10.0, std::floor(source.Uniform(-100.0, 100.0)));
    Problem problem = source.Everyday();
    problem.u0 *= scale;
    problem.v0 *= scale;
    if (source.Below(2) == 0) {
      const double mobility = std::pow(10.0, std::floor(source.Uniform(-100.0, 100.0)));
      problem.w = {problem.w.tt * mobility, problem.w.tn * mobility, problem.w.nn * mobility};
    }
    both.Add(problem);
  }
  for (int i = 0; i < kScenes / 10 && !testing::Test::HasFailure(); ++i) both.Add(source.OverAllDoubles());
  both.Print();
}

// u0 and Wtn are as small as rounding leaves numbers that should be 0.
TEST(PlanarRoundingTest, ClaimsHoldForSlipAndCouplingThatAreNearlyZero) {
  Both both;
  SceneSource source(19);
  for (int i = 0; i < kScenes && !testing::Test::HasFailure(); ++i) {
    Problem problem = source.Everyday();
    if (i % 3 != 0) problem.u0 *= std::exp2(-source.Uniform(30.0, 110.0));
    if (i % 3 != 1) problem.w.tn *= std::exp2(-source.Uniform(30.0, 110.0));
    both.Add(problem);
  }
  both.Print();
  EXPECT_GT(both.plain.count(), kScenes * 7 / 10);
}

// The bounds that follow for the coefficients from those on velocities, impulses and works, as docs/theory states.
TEST(PlanarRoundingTest, BoundsOnCoefficientsFollow) {
  SceneSource source(15);
  for (int i = 0; i < kScenes && !HasFailure(); ++i) {
    const Problem problem = source.Any();
    const PlainImpact plain = SolvePlain(problem);
    if (!plain.proved || plain.impact.regime == Regime::kLocked || problem.coefficient == 0.0) continue;
    const Impact& impact = plain.impact;
    const ExactImpact exact = SolveExactly(problem);
    const double speed = std::max(std::fabs(problem.u0), std::fabs(problem.v0));
    const double in_v = plain.errors.velocity * speed;
    const double in_tau = plain.errors.impulse * speed / problem.w.nn;
    const double in_f = problem.w.tt == 0.0 ? 0.0 : plain.errors.impulse * speed / problem.w.tt;
    const double in_work = plain.errors.work * TotalWork(exact).Nearest();
    const auto within = [&](double computed, const Ball& value, double bound) {
      return Distance(computed, value).UpperBound() <= 1.1 * (bound + 0x1p-51 * std::fabs(computed));
    };
    EXPECT_TRUE(within(impact.newton, exact.newton, in_v / -problem.v0)) << ToString(problem);
    EXPECT_TRUE(within(impact.poisson, exact.poisson, in_tau * (2.0 + impact.poisson) / impact.tau_compression))
        << ToString(problem);
    const double stored = -impact.work_normal_compression;
    const double in_square = in_work * (1.0 + impact.energetic * impact.energetic) / stored;
    EXPECT_TRUE(within(impact.energetic * impact.energetic, exact.energetic * exact.energetic, in_square))
        << ToString(problem);
    EXPECT_TRUE(within(impact.tangential, exact.end().f / exact.end().tau,
                       (in_f + std::fabs(impact.tangential) * in_tau) / impact.tau1))
        << ToString(problem);
  }
}

// ---- Signs ----

struct Tie {
  const char* name;
  Problem problem;
};

// Each is decided by a number that is 0, so that rounding alone would decide.
std::vector<Tie> Ties() {
  const RestitutionLaw law = RestitutionLaw::kEnergetic;
  return {
      {"slip stops where compression ends",
       {.w = {4.0, 0.0, 1.0}, .u0 = 2.0, .v0 = -1.0, .mu = 0.5, .mu_static = 0.5, .law = law, .coefficient = 0.5}},
      {"slip stops where restitution ends",
       {.w = {4.0, 0.0, 1.0}, .u0 = 3.0, .v0 = -1.0, .mu = 0.5, .mu_static = 0.5, .law = law, .coefficient = 0.5}},
  };
}

TEST(PlanarRoundingTest, PlainArithmeticDecidesNoTie) {
  for (const Tie& tie : Ties()) EXPECT_FALSE(SolvePlain(tie.problem).proved) << tie.name;
}

// Within some ulp of a threshold rounded signs are wrong now and then; plain arithmetic must not call them proved.
TEST(PlanarRoundingTest, NoRegimeIsDecidedByARoundedSign) {
  SceneSource source(16);
  int unproved = 0;
  for (int i = 0; i < kScenes && !testing::Test::HasFailure(); ++i) {
    const Problem problem = i % 2 == 0 ? source.NearStopAtRest() : source.NearStopAtEnd();
    const PlainImpact plain = SolvePlain(problem);
    if (plain.proved) {
      ExpectSameCourse(problem, plain.impact, SolveExactly(problem));
    } else {
      ++unproved;
    }
  }
  EXPECT_GT(unproved, kScenes / 10);
}

TEST(PlanarRoundingTest, NumbersBeyondTheRangeOfPlainArithmeticAreNotProved) {
  Problem problem = FortyFiveDegreeRod(RestitutionLaw::kEnergetic, 0.5);
  EXPECT_TRUE(SolvePlain(problem).proved);
  problem.u0 = -1e-13;
  EXPECT_TRUE(SolvePlain(problem).proved);
  problem.u0 = -1e-31;
  EXPECT_FALSE(SolvePlain(problem).proved);
  problem.u0 = 0.0;
  problem.mu = 1e-13;
  EXPECT_FALSE(SolvePlain(problem).proved);
}

// One number at a time crosses an end of the range that core/models/planar/planar.h states, or is 0.
TEST(PlanarRoundingTest, PlainArithmeticServesUpToTheEndsOfItsRange) {
  struct Number {
    const char* name;
    double Problem::*of;
    double least;
  };
  const Problem typical = {
      .w = {2.0, 0.5, 1.5}, .u0 = 0.3, .v0 = -1.0, .mu = 0.2, .mu_static = 0.3, .coefficient = 0.5};
  for (const auto& [name, of, least] : {Number{"u0", &Problem::u0, 0x1p-100}, Number{"mu", &Problem::mu, 0x1p-40},
                                        Number{"coefficient", &Problem::coefficient, 0x1p-40}}) {
    Problem problem = typical;
    for (const auto& [size, serves] : {std::pair(least, true), std::pair(0.99 * least, false), std::pair(0.0, true)}) {
      problem.*of = size;
      EXPECT_EQ(SolvePlain(problem).proved, serves) << name << " = " << size;
    }
  }
  Problem weak = typical;
  weak.w.tn = 0x1p-100;
  EXPECT_TRUE(SolvePlain(weak).proved);
  weak.w.tn *= 0.99;
  EXPECT_FALSE(SolvePlain(weak).proved);
  Problem fast = typical;
  fast.v0 = -0x1p40;
  fast.u0 = 0x1p40;
  EXPECT_TRUE(SolvePlain(fast).proved);
  fast.v0 *= 1.01;
  EXPECT_FALSE(SolvePlain(fast).proved);
  fast.v0 = -0x1p39;
  fast.u0 *= 1.01;
  EXPECT_FALSE(SolvePlain(fast).proved);
}

TEST(PlanarRoundingTest, ASeparatingContactHasNoError) {
  Problem problem = FortyFiveDegreeRod();
  problem.v0 = 1.0;
  const PlainImpact plain = SolvePlain(problem);
  EXPECT_TRUE(plain.proved);
  EXPECT_EQ(plain.impact.regime, Regime::kSeparating);
  EXPECT_EQ(plain.errors.Largest(), 0.0);
}

// ---- Bits ----

TEST(PlanarRoundingTest, AskingForErrorsDoesNotChangeTheAnswer) {
  SceneSource source(17);
  for (int i = 0; i < kScenes && !HasFailure(); ++i) {
    const Problem problem = i % 8 == 0 ? source.OverAllDoubles() : source.Any();
    RoundingErrors errors;
    const Impact with = Solve(problem, errors);
    const Impact without = Solve(problem);
    EXPECT_EQ(std::bit_cast<uint64_t>(with.u1), std::bit_cast<uint64_t>(without.u1));
    EXPECT_EQ(std::bit_cast<uint64_t>(with.f1), std::bit_cast<uint64_t>(without.f1));
    EXPECT_EQ(std::bit_cast<uint64_t>(with.energy_change), std::bit_cast<uint64_t>(without.energy_change));
  }
}

std::vector<uint64_t> BitsOf(const PlainImpact& plain) {
  const Impact& impact = plain.impact;
  std::vector<uint64_t> bits = {plain.proved ? 1U : 0U, static_cast<uint64_t>(impact.regime)};
  for (const double number :
       {plain.errors.velocity, plain.errors.impulse, plain.errors.work, impact.u1, impact.v1, impact.tau_compression,
        impact.tau1, impact.f1, impact.f_compression, impact.newton, impact.poisson, impact.energetic,
        impact.energetic_excess, impact.tangential, impact.work_normal_compression, impact.work_normal_restitution,
        impact.work_tangential_compression, impact.work_tangential_restitution, impact.energy_change}) {
    bits.push_back(std::bit_cast<uint64_t>(number));
  }
  return bits;
}

TEST(PlanarRoundingTest, EverySimdTargetGivesTheSameBits) {
  const auto all = [] {
    std::vector<uint64_t> bits;
    SceneSource source(18);
    for (int i = 0; i < kScenes; ++i) {
      const std::vector<uint64_t> one = BitsOf(SolvePlain(source.Any()));
      bits.insert(bits.end(), one.begin(), one.end());
    }
    return bits;
  };
  const std::vector<uint64_t> expected = all();
  EXPECT_TRUE(all() == expected);
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    const OnlyTarget only(target);
    EXPECT_TRUE(all() == expected) << hwy::TargetName(target);
  }
}

}  // namespace
}  // namespace ricochet::planar
