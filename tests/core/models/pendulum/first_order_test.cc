// The first-order form, compared with the exact pendulum: errors stay within the proved bounds, and not far below them.

#include "core/models/pendulum/first_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "core/answer/model_outcomes.h"
#include "core/bounds/pendulum_bounds.h"
#include "core/models/restitution_law.h"
#include "tests/support/scenes/made_outcome.h"
#include "tests/support/scenes/pendulum_scenes.h"

namespace ricochet::first_order {
namespace {

using pendulum::SceneSource;
using pendulum::ToString;

constexpr double kUlp = std::numeric_limits<double>::epsilon();
constexpr std::array kLaws = {RestitutionLaw::kNewton, RestitutionLaw::kPoisson, RestitutionLaw::kEnergetic};

// The largest coefficient that the first-order bound [57] allows.
double LargestCoefficient(RestitutionLaw law, double x) {
  return law == RestitutionLaw::kNewton ? 1.0 - x : law == RestitutionLaw::kPoisson ? 1.0 + x : 1.0;
}

// mu |b|/a = x to rounding, at any ratio b/a.
Problem Leaning(double x, RestitutionLaw law, double share, SceneSource& source) {
  Problem problem = {.inertia = source.Uniform(0.1, 10.0),
                     .a = source.Uniform(0.1, 10.0),
                     .b = source.Sign() * std::exp2(source.Uniform(-8.0, 8.0)),
                     .omega_minus = -source.Uniform(0.1, 10.0),
                     .law = law};
  problem.mu = x * problem.a / std::fabs(problem.b);
  problem.mu_static = problem.mu;
  problem.coefficient = share * LargestCoefficient(law, x) * (1.0 - 0x1p-40);
  return problem;
}

double Scale(const Problem& p) { return std::max(p.a, std::fabs(p.b)) * -p.omega_minus; }

struct Errors {
  double velocity, impulse;
};

// The errors of the model, relative to the same scale as the bounds; `rounding` grows by that of the exact solution.
Errors TrueErrors(const Problem& p, const Impact& impact, const pendulum::Impact& exact, Errors& rounding) {
  const double normal = p.a * p.a / p.inertia;
  const double tangential = p.b * p.b / p.inertia;
  const auto error = [&](Output o) { return std::fabs(impact[o] - exact[o]); };
  const auto ulp = [&](Output o) { return kUlp * std::fabs(exact[o]); };
  const auto most = [&](const auto& of) {
    return Errors{std::max(of(Output::kTangentialVelocityAfter), of(Output::kNormalVelocityAfter)) / Scale(p),
                  std::max({normal * of(Output::kNormalImpulse), normal * of(Output::kNormalImpulseCompression),
                            tangential * of(Output::kTangentialImpulse),
                            tangential * of(Output::kTangentialImpulseCompression)}) /
                      Scale(p)};
  };
  rounding = most(ulp);
  return most(error);
}

TEST(FirstOrderTest, ErrorsAreWithinTheBoundsWhichAreNotFarAboveThem) {
  for (const RestitutionLaw law : kLaws) {
    SceneSource source(501 + static_cast<uint64_t>(law));
    int scenes = 0;
    int near = 0;
    double worst = 0.0;
    for (int i = 0; i < 34'000; ++i) {
      const double x =
          i % 100 == 0 ? kLargestX * (1.0 - 0x1p-40) : std::pow(10.0, source.Uniform(-8.0, std::log10(0.5)));
      const double share = i % 8 == 0 ? static_cast<double>(i / 8 % 2) : source.Uniform(0.0, 1.0);
      const Problem p = Leaning(x, law, share, source);
      if (!Serves(p)) continue;
      const RelativeErrors bound = ErrorsOf(p);
      Errors rounding;
      const Errors error = TrueErrors(p, first_order::Solve(p), pendulum::Solve(p), rounding);
      ASSERT_LE(error.velocity, bound.velocity + rounding.velocity) << ToString(p);
      ASSERT_LE(error.impulse, bound.impulse + rounding.impulse) << ToString(p);
      worst = std::max(worst, error.velocity / bound.velocity);
      worst = std::max(worst, error.impulse / bound.impulse);
      if (bound.Largest() <= 100.0 * std::max(error.velocity, error.impulse)) ++near;
      ++scenes;
    }
    std::printf("  law %d: worst error %.3f of its bound; bound within 100 errors in %.1f %% of %d scenes\n",
                static_cast<int>(law), worst, 100.0 * near / scenes, scenes);
    EXPECT_GE(scenes, 33'900);
    EXPECT_GE(near, 0.9 * scenes);
    EXPECT_GT(worst, 0.5);
  }
}

// These decades of x are so large that rounding does not matter.
TEST(FirstOrderTest, ErrorsFallWithTheSquareOfXAndAreBelowTheConstantsStated) {
  for (const RestitutionLaw law : kLaws) {
    std::vector<double> velocity, impulse;
    for (const double x : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5}) {
      SceneSource source(510);
      Errors largest = {0.0, 0.0};
      for (int i = 0; i < 200; ++i) {
        const Problem p = Leaning(x, law, source.Uniform(0.0, 1.0), source);
        Errors rounding;
        const Errors error = TrueErrors(p, first_order::Solve(p), pendulum::Solve(p), rounding);
        const double square = p.coefficient * x * x;
        ASSERT_LE(error.velocity, 2.0 * square + 16.0 * kUlp);
        ASSERT_LE(error.impulse, 8.0 / 3.0 * square + 32.0 * kUlp);
        largest = {std::max(largest.velocity, error.velocity), std::max(largest.impulse, error.impulse)};
      }
      velocity.push_back(largest.velocity);
      impulse.push_back(largest.impulse);
    }
    for (size_t i = 1; i < velocity.size(); ++i) {
      // The coefficient that the law states is exact.
      if (law == RestitutionLaw::kNewton) {
        EXPECT_LT(velocity[i], 4.0 * kUlp);
      } else {
        EXPECT_NEAR(std::log10(velocity[i - 1] / velocity[i]), 2.0, 0.05);
      }
      if (law == RestitutionLaw::kPoisson) {
        EXPECT_LT(impulse[i], 16.0 * kUlp);
      } else {
        EXPECT_NEAR(std::log10(impulse[i - 1] / impulse[i]), 2.0, 0.05);
      }
    }
  }
}

TEST(FirstOrderTest, CoefficientsAreTheFirstOrderFormsOfTheLaw) {
  for (const RestitutionLaw law : kLaws) {
    SceneSource source(520 + static_cast<uint64_t>(law));
    for (int i = 0; i < 1'000; ++i) {
      const Problem p = Leaning(std::pow(10.0, source.Uniform(-6.0, -0.4)), law, source.Uniform(0.0, 1.0), source);
      const Impact impact = first_order::Solve(p);
      const auto forms = SolveNearlyVertical(p, true).coefficients;
      ASSERT_NEAR(impact[Output::kNewton], forms->newton, 8.0 * kUlp);
      ASSERT_NEAR(impact[Output::kPoisson], *forms->poisson, 8.0 * kUlp);
      ASSERT_NEAR(impact[Output::kEnergetic], *forms->energetic, 8.0 * kUlp);
      ASSERT_NEAR(impact[Output::kTangentialCoefficient], forms->tangential, 8.0 * kUlp * p.mu);
    }
  }
}

struct RefusedCase {
  const char* why;
  Problem problem;
};

TEST(FirstOrderTest, ServesNothingOutsideOfItsRange) {
  const Problem fine = {.inertia = 2.0,
                        .a = 4.0,
                        .b = 1.0,
                        .omega_minus = -1.0,
                        .mu = 0.4,
                        .mu_static = 0.4,
                        .law = RestitutionLaw::kNewton,
                        .coefficient = 0.5};
  ASSERT_TRUE(Serves(fine));
  const auto with = [&](auto change) {
    Problem problem = fine;
    change(problem);
    return problem;
  };
  const std::vector<RefusedCase> cases = {
      {"separates", with([](Problem& p) { p.omega_minus = 1.0; })},
      {"stands still", with([](Problem& p) { p.omega_minus = 0.0; })},
      {"has no friction", with([](Problem& p) { p.mu = 0.0; })},
      {"is vertical", with([](Problem& p) { p.b = 0.0; })},
      {"leans too far", with([](Problem& p) { p.b = 5.01; })},
      {"is locked by static friction", with([](Problem& p) { p.mu_static = 4.0; })},
      {"returns too much, Newton", with([](Problem& p) { p.coefficient = 0.9; })},
      {"returns too much, Poisson", with([](Problem& p) {
         p.law = RestitutionLaw::kPoisson;
         p.coefficient = 1.1;
       })},
      {"is too small for doubles", with([](Problem& p) { p.inertia = 0x1p-101; })},
      {"is too large for doubles", with([](Problem& p) { p.omega_minus = -0x1p101; })},
      {"has a coefficient too small for doubles", with([](Problem& p) { p.coefficient = 0x1p-101; })},
  };
  for (const RefusedCase& each : cases) EXPECT_FALSE(Serves(each.problem)) << each.why;
}

TEST(FirstOrderTest, WhatItServesReboundsAndIsAdmissible) {
  SceneSource source(530);
  int served = 0;
  for (int i = 0; i < 100'000; ++i) {
    const Problem p = i % 2 == 0 ? source.NearLimit() : i % 4 == 1 ? source.NearLocking() : source.Any();
    if (!Serves(p)) continue;
    const pendulum::Impact exact = pendulum::Solve(p);
    ASSERT_EQ(exact.regime, Regime::kRebound) << ToString(p);
    ASSERT_FALSE(exact.sharp_limit_broken) << ToString(p);
    ASSERT_LE(first_order::Solve(p)[Output::kEnergetic], 1.0) << ToString(p);
    ++served;
  }
  EXPECT_GT(served, 10'000);
}

TEST(FirstOrderTest, WorksAddUpToTheEnergyOfTheVelocitiesAndAreExactToSecondOrder) {
  for (const RestitutionLaw law : kLaws) {
    SceneSource source(540 + static_cast<uint64_t>(law));
    for (int i = 0; i < 10'000; ++i) {
      const Problem p =
          Leaning(std::pow(10.0, source.Uniform(-8.0, std::log10(0.5))), law, source.Uniform(0.0, 1.0), source);
      if (!Serves(p)) continue;
      const Impact impact = first_order::Solve(p);
      const pendulum::Impact exact = pendulum::Solve(p);
      const double before = 0.5 * p.inertia * p.omega_minus * p.omega_minus;
      const double works = impact[Output::kWorkNormalCompression] + impact[Output::kWorkNormalRestitution] +
                           impact[Output::kWorkTangentialCompression] + impact[Output::kWorkTangentialRestitution];
      ASSERT_NEAR(works, impact[Output::kEnergyChange], 32.0 * kUlp * before) << ToString(p);
      ASSERT_NEAR(impact[Output::kWorkNormal] + impact[Output::kWorkTangential], works, 32.0 * kUlp * before);
      const double off = ErrorsOf(p).velocity;
      const double x = FrictionRatio(p);
      const double allowed = before * ((2.0 * exact[Output::kNewton] + off) * off / (1.0 - x) + 32.0 * kUlp);
      for (const Output output :
           {Output::kWorkNormalCompression, Output::kWorkNormalRestitution, Output::kWorkTangentialCompression,
            Output::kWorkTangentialRestitution, Output::kEnergyChange}) {
        ASSERT_NEAR(impact[output], exact[output], allowed) << ToString(p) << " " << static_cast<int>(output);
      }
    }
  }
}

// A body that meets the surface right below its pin has no tangential velocity, so that friction does nothing.
TEST(FirstOrderTest, RightBelowThePinFrictionHasNoImpulse) {
  for (const RestitutionLaw law : kLaws) {
    const Problem problem = {.inertia = 2.0,
                             .a = 0.6,
                             .b = 0.0,
                             .omega_minus = -1.0,
                             .mu = 0.5,
                             .mu_static = 0.5,
                             .law = law,
                             .coefficient = 0.5};
    const Impact impact = first_order::Solve(problem);
    EXPECT_EQ(impact.regime, Regime::kFrictionless);
    EXPECT_EQ(impact[Output::kTangentialImpulse], 0.0);
    EXPECT_EQ(impact[Output::kTangentialImpulseCompression], 0.0);
    EXPECT_EQ(impact[Output::kTangentialCoefficient], 0.0);
    EXPECT_EQ(first_order::At(problem, 1.0).tangential_impulse, 0.0);
    EXPECT_DOUBLE_EQ(impact[Output::kNormalImpulse], 2.0 * 1.5 / 0.6);
  }
}

TEST(FirstOrderTest, HistoriesAreBilinearAndMeetTheEvents) {
  for (const RestitutionLaw law : kLaws) {
    SceneSource source(550 + static_cast<uint64_t>(law));
    for (int i = 0; i < 2'000; ++i) {
      const Problem p = Leaning(std::pow(10.0, source.Uniform(-6.0, -0.4)), law, source.Uniform(0.01, 1.0), source);
      const Impact impact = first_order::Solve(p);
      const double tau0 = impact[Output::kNormalImpulseCompression];
      const double tau1 = impact[Output::kNormalImpulse];
      const double force = std::copysign(p.mu, p.b);
      EXPECT_EQ(first_order::At(p, 0.0).omega, p.omega_minus);
      EXPECT_EQ(first_order::At(p, 0.0).tangential_impulse, 0.0);
      EXPECT_EQ(first_order::At(p, tau0).omega, 0.0);
      EXPECT_EQ(first_order::At(p, tau0).tangential_impulse, impact[Output::kTangentialImpulseCompression]);
      EXPECT_EQ(first_order::At(p, tau1).omega, impact[Output::kOmegaPlus]);
      EXPECT_EQ(first_order::At(p, tau1).tangential_impulse, impact[Output::kTangentialImpulse]);
      const Instant falling = first_order::At(p, 0.25 * tau0);
      EXPECT_NEAR(falling.omega, 0.75 * p.omega_minus, 4.0 * kUlp * -p.omega_minus);
      EXPECT_NEAR(falling.tangential_impulse, 0.25 * force * tau0, 4.0 * kUlp * p.mu * tau0);
      const double later = tau0 + 0.5 * (tau1 - tau0);
      const Instant rising = first_order::At(p, later);
      const double loss = 4.0 * kUlp * tau1 / (tau1 - tau0);  // later - tau0 is as exact as that.
      EXPECT_NEAR(rising.omega, 0.5 * impact[Output::kOmegaPlus], loss * impact[Output::kOmegaPlus]);
      EXPECT_NEAR(rising.tangential_impulse, force * (2.0 * tau0 - later), 8.0 * kUlp * p.mu * tau1);
    }
  }
}

TEST(FirstOrderOutcomeTest, IsThePendulumsWithinItsBound) {
  for (const RestitutionLaw law : kLaws) {
    SceneSource source(560 + static_cast<uint64_t>(law));
    const Problem p = Leaning(1e-5, law, 0.9, source);
    const double tau1 = first_order::Solve(p)[Output::kNormalImpulse];
    const auto with_history = [&p](const std::vector<double>& taus) {
      return Made([&](Outcome& made) { return first_order::MakeOutcome(p, {.history_at_n_s = taus}, made); });
    };
    const Outcome outcome = with_history({0.0, tau1}).value();
    const Outcome exact = Made([&p](Outcome& made) { return pendulum::MakeOutcome(p, 0.0, {}, made); }).value();
    EXPECT_EQ(outcome.regime, exact.regime);
    EXPECT_TRUE(outcome.admissible);
    EXPECT_EQ(outcome.w_rank, 1);
    EXPECT_EQ(outcome.accuracy.kind, AccuracyKind::kBound);
    EXPECT_EQ(outcome.accuracy.relative_error, ErrorsOf(p).velocity);
    ASSERT_EQ(outcome.timeline.size(), exact.timeline.size());
    for (size_t i = 0; i < exact.timeline.size(); ++i) EXPECT_EQ(outcome.timeline[i].kind, exact.timeline[i].kind);
    EXPECT_NEAR(outcome.rates_after_rad_s[0], exact.rates_after_rad_s[0], 3e-10 * -p.omega_minus);
    EXPECT_NEAR(outcome.impulse.normal_total_n_s, exact.impulse.normal_total_n_s, 3e-10 * tau1);
    EXPECT_NEAR(outcome.coefficients.tangential, exact.coefficients.tangential, 3e-10 * p.mu);
    EXPECT_NEAR(outcome.work.residual_j, 0.0, 32.0 * kUlp * p.inertia * p.omega_minus * p.omega_minus);
    ASSERT_EQ(outcome.history.size(), 2U);
    EXPECT_EQ(outcome.history[0].rates_rad_s[0], p.omega_minus);
    EXPECT_EQ(outcome.history[1].contact_velocity, outcome.contact_velocity_after);
    EXPECT_EQ(with_history({1.1 * tau1}).status().code(), absl::StatusCode::kInvalidArgument);
  }
}

}  // namespace
}  // namespace ricochet::first_order
