// The bounds of Lubarda (2009): against ball arithmetic, against the solver, and against their first-order forms.

#include "core/bounds/pendulum_bounds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/models/pendulum/pendulum.h"
#include "core/models/restitution_law.h"
#include "tests/support/oracles/pendulum_oracle.h"
#include "tests/support/scenes/pendulum_scenes.h"

namespace ricochet::pendulum {
namespace {

constexpr int kScenes = 100'000;
constexpr double kPromisedUlps = 1.0;  // core/bounds/pendulum_bounds.h

Problem Make(double a, double b, double mu) {
  return {.inertia = 2.0, .a = a, .b = b, .omega_minus = -3.0, .mu = mu, .mu_static = mu};
}

// ---- Values ----

double RangeError(const Range& range, const ExactRange& exact) {
  return std::max(ErrorInUlps(range.lower, exact.lower), ErrorInUlps(range.upper, exact.upper));
}

// A sharp bound may be the double below the rounded one, so that the solver accepts it.
double SharpError(const Range& range, const ExactRange& exact) {
  EXPECT_EQ(range.lower, 0.0);
  const double above = std::nextafter(range.upper, std::numeric_limits<double>::infinity());
  return std::min(ErrorInUlps(range.upper, exact.upper), ErrorInUlps(above, exact.upper));
}

void ExpectExact(const Problem& problem, const Bounds& bounds, const ExactBounds& exact) {
  const std::vector<std::pair<const char*, double>> errors = {
      {"friction_ratio", ErrorInUlps(bounds.friction_ratio, exact.friction_ratio)},
      {"slope_ratio", ErrorInUlps(bounds.slope_ratio, exact.slope_ratio)},
      {"sharp newton", SharpError(bounds.sharp.newton, exact.sharp.newton)},
      {"sharp poisson", SharpError(bounds.sharp.poisson, exact.sharp.poisson)},
      {"sharp energetic", RangeError(bounds.sharp.energetic, exact.sharp.energetic)},
      {"sharp tangential", RangeError(bounds.sharp.tangential, exact.sharp.tangential)},
      {"sharp normal_total", RangeError(bounds.sharp.normal_total_n_s, exact.sharp.normal_total)},
      {"energy newton", RangeError(bounds.energy_only->newton, exact.energy_only.newton)},
      {"energy poisson", RangeError(bounds.energy_only->poisson, exact.energy_only.poisson)},
      {"energy energetic", RangeError(bounds.energy_only->energetic, exact.energy_only.energetic)},
      {"energy tangential", RangeError(bounds.energy_only->tangential, exact.energy_only.tangential)},
      {"energy normal_total", RangeError(bounds.energy_only->normal_total_n_s, exact.energy_only.normal_total)},
  };
  for (const auto& [name, error] : errors) ASSERT_LE(error, kPromisedUlps) << name << " at " << ToString(problem);
}

TEST(PendulumBoundsTest, EveryBoundIsWithinOneUlpOverAllDoubles) {
  SceneSource source(54);
  for (int i = 0; i < kScenes && !HasFatalFailure(); ++i) {
    const Problem problem = source.AnyImpact();
    const Bounds bounds = SolveBounds(problem);
    const ExactBounds exact = SolveBoundsExactly(problem);
    ASSERT_EQ(bounds.regime, exact.regime) << ToString(problem);
    ExpectExact(problem, bounds, exact);
  }
}

// After (55): mu = 0.1, a/b = 0.3.
TEST(PendulumBoundsTest, PaperExampleAtXOneThird) {
  const Bounds bounds = SolveBounds(Make(0.3, 1.0, 0.1));
  EXPECT_EQ(bounds.regime, Regime::kRebound);
  EXPECT_NEAR(bounds.friction_ratio, 1.0 / 3.0, 1e-16);
  EXPECT_NEAR(bounds.slope_ratio, 0.5, 1e-15);
  EXPECT_NEAR(bounds.sharp.newton.upper, std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(bounds.sharp.poisson.upper, std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(bounds.energy_only->poisson.upper, 2.0, 1e-15);
  EXPECT_NEAR(bounds.sharp.tangential.lower, -0.0172, 5e-5);
  EXPECT_EQ(bounds.sharp.tangential.upper, 0.1);
  EXPECT_NEAR(bounds.sharp.normal_total_n_s.upper, 6.0 / 0.4 * (1.0 + std::sqrt(2.0)), 1e-13);
}

TEST(PendulumBoundsTest, BoundsOfTheTangentialCoefficientMirrorWithTheSideOfTheContact) {
  const Bounds right = SolveBounds(Make(0.3, 1.0, 0.1));
  const Bounds left = SolveBounds(Make(0.3, -1.0, 0.1));
  EXPECT_EQ(left.sharp.tangential.lower, -right.sharp.tangential.upper);
  EXPECT_EQ(left.sharp.tangential.upper, -right.sharp.tangential.lower);
  EXPECT_EQ(left.energy_only->tangential.upper, -right.energy_only->tangential.lower);
  EXPECT_EQ(left.sharp.newton, right.sharp.newton);
}

TEST(PendulumBoundsTest, WithoutFrictionAllThreeCoefficientsReachOne) {
  for (const Problem& problem : {Make(0.3, 1.0, 0.0), Make(0.3, 0.0, 0.5)}) {
    const Bounds bounds = SolveBounds(problem);
    EXPECT_EQ(bounds.regime, Regime::kFrictionless);
    EXPECT_EQ(bounds.sharp.newton, (Range{0.0, 1.0}));
    EXPECT_EQ(bounds.sharp.poisson, (Range{0.0, 1.0}));
    EXPECT_EQ(bounds.sharp.tangential, (Range{0.0, 0.0}));
    EXPECT_EQ(bounds.energy_only->poisson, (Range{0.0, 1.0}));
    EXPECT_EQ(bounds.sharp.normal_total_n_s.upper, 2.0 * bounds.sharp.normal_total_n_s.lower);
  }
}

TEST(PendulumBoundsTest, LockedPendulumHasOneValueOfEverything) {
  const Bounds bounds = SolveBounds(Make(1.0, 4.0, 0.5));
  EXPECT_EQ(bounds.regime, Regime::kLocked);
  EXPECT_EQ(bounds.friction_ratio, 2.0);
  EXPECT_EQ(bounds.slope_ratio, -1.0 / 3.0);
  EXPECT_EQ(bounds.sharp.newton, Range());
  EXPECT_EQ(bounds.sharp.poisson, Range());
  EXPECT_EQ(bounds.sharp.energetic, Range());
  EXPECT_EQ(bounds.sharp.tangential, (Range{0.5, 0.5}));
  EXPECT_EQ(bounds.sharp.normal_total_n_s, (Range{2.0, 2.0}));
  EXPECT_EQ(bounds.energy_only, bounds.sharp);
}

TEST(PendulumBoundsTest, SeparatingContactHasNoImpulse) {
  Problem problem = Make(1.0, 1.0, 0.5);
  problem.omega_minus = 0.0;
  const Bounds bounds = SolveBounds(problem);
  EXPECT_EQ(bounds.regime, Regime::kSeparating);
  EXPECT_EQ(bounds.sharp.normal_total_n_s, Range());
}

// ---- Bounds and solver agree ----

double UpperOf(const CoefficientBounds& bounds, RestitutionLaw law) {
  switch (law) {
    case RestitutionLaw::kNewton:
      return bounds.newton.upper;
    case RestitutionLaw::kPoisson:
      return bounds.poisson.upper;
    case RestitutionLaw::kEnergetic:
      return bounds.energetic.upper;
  }
  return 0.0;
}

TEST(PendulumBoundsTest, TheBoundFedBackIsAdmissibleForEveryLaw) {
  SceneSource source(30);
  for (int i = 0; i < kScenes; ++i) {
    Problem problem = source.AnyImpact();
    const Bounds bounds = SolveBounds(problem);
    if (bounds.regime == Regime::kLocked) continue;
    for (const RestitutionLaw law : {RestitutionLaw::kNewton, RestitutionLaw::kPoisson, RestitutionLaw::kEnergetic}) {
      problem.law = law;
      problem.coefficient = UpperOf(bounds.sharp, law);
      if (!std::isfinite(problem.coefficient)) continue;
      const Impact impact = Solve(problem);
      ASSERT_FALSE(impact.sharp_limit_broken) << ToString(problem);
      ASSERT_FALSE(impact.energy_limit_broken) << ToString(problem);
    }
  }
}

TEST(PendulumBoundsTest, ThreeUlpAboveTheBoundIsInadmissibleForEveryLaw) {
  SceneSource source(30);
  for (int i = 0; i < kScenes; ++i) {
    Problem problem = source.AnyImpact();
    const Bounds bounds = SolveBounds(problem);
    if (bounds.regime == Regime::kLocked) continue;
    for (const RestitutionLaw law : {RestitutionLaw::kNewton, RestitutionLaw::kPoisson}) {
      problem.law = law;
      problem.coefficient = UpperOf(bounds.sharp, law);
      for (int k = 0; k < 3; ++k) problem.coefficient = std::nextafter(problem.coefficient, HUGE_VAL);
      if (!std::isfinite(problem.coefficient)) continue;
      ASSERT_TRUE(Solve(problem).sharp_limit_broken) << ToString(problem);
    }
  }
}

// Footnote of Section 8.1: (55) is reached in the elastic impact, mu where nothing comes back.
TEST(PendulumBoundsTest, BoundsAreAttainedAtEtaZeroAndOne) {
  SceneSource source(55);
  for (int i = 0; i < 10'000; ++i) {
    Problem problem = source.AnyImpact();
    const Bounds bounds = SolveBounds(problem);
    if (bounds.regime == Regime::kLocked) continue;
    problem.law = RestitutionLaw::kEnergetic;
    problem.coefficient = 1.0;
    const Impact elastic = Solve(problem);
    problem.coefficient = 0.0;
    const Impact dead = Solve(problem);
    const Range& tangential = bounds.sharp.tangential;
    const bool mirrored = problem.b < 0.0;
    ASSERT_DOUBLE_EQ(elastic[Output::kTangentialCoefficient], mirrored ? tangential.upper : tangential.lower);
    ASSERT_DOUBLE_EQ(dead[Output::kTangentialCoefficient], mirrored ? tangential.lower : tangential.upper);
    ASSERT_DOUBLE_EQ(elastic[Output::kNormalImpulse], bounds.sharp.normal_total_n_s.upper);
    ASSERT_DOUBLE_EQ(dead[Output::kNormalImpulse], bounds.sharp.normal_total_n_s.lower);
    ASSERT_DOUBLE_EQ(elastic[Output::kNewton], bounds.sharp.newton.upper);
    ASSERT_DOUBLE_EQ(elastic[Output::kPoisson], bounds.sharp.poisson.upper);
  }
}

TEST(PendulumBoundsTest, AdmissibleImpactsStayWithinTheBounds) {
  SceneSource source(31);
  const auto inside = [](const Range& range, double value) {
    return value >= std::nextafter(range.lower, -HUGE_VAL) && value <= std::nextafter(range.upper, HUGE_VAL);
  };
  for (int i = 0; i < kScenes; ++i) {
    const Problem problem = source.AnyImpact();
    const Impact impact = Solve(problem);
    if (impact.sharp_limit_broken) continue;
    const Bounds bounds = SolveBounds(problem);
    ASSERT_TRUE(inside(bounds.sharp.newton, impact[Output::kNewton])) << ToString(problem);
    ASSERT_TRUE(inside(bounds.sharp.poisson, impact[Output::kPoisson])) << ToString(problem);
    ASSERT_TRUE(inside(bounds.sharp.tangential, impact[Output::kTangentialCoefficient])) << ToString(problem);
    ASSERT_TRUE(inside(bounds.sharp.normal_total_n_s, impact[Output::kNormalImpulse])) << ToString(problem);
  }
}

TEST(PendulumBoundsTest, EnergyAloneGivesWeakerBounds) {
  SceneSource source(28);
  const auto contains = [](const Range& outer, const Range& inner) {
    return outer.lower <= inner.lower && outer.upper >= inner.upper;
  };
  for (int i = 0; i < kScenes; ++i) {
    const Problem problem = source.AnyImpact();
    const Bounds bounds = SolveBounds(problem);
    ASSERT_TRUE(contains(bounds.energy_only->newton, bounds.sharp.newton)) << ToString(problem);
    ASSERT_TRUE(contains(bounds.energy_only->poisson, bounds.sharp.poisson)) << ToString(problem);
    ASSERT_TRUE(contains(bounds.energy_only->energetic, bounds.sharp.energetic)) << ToString(problem);
    ASSERT_TRUE(contains(bounds.energy_only->tangential, bounds.sharp.tangential)) << ToString(problem);
    ASSERT_TRUE(contains(bounds.energy_only->normal_total_n_s, bounds.sharp.normal_total_n_s)) << ToString(problem);
  }
}

// ---- Nearly vertical ----

// Section 9: mu = 0.4, a = 4b.
TEST(NearlyVerticalTest, PaperExampleAtXOneTenth) {
  const NearlyVertical form = SolveNearlyVertical(Make(4.0, 1.0, 0.4), false);
  EXPECT_NEAR(form.bounds.poisson.upper, 1.1, 1e-15);
  EXPECT_NEAR(form.bounds.newton.upper, 0.9, 1e-15);
  EXPECT_NEAR(form.bounds.tangential.lower, -0.02, 1e-16);
  EXPECT_EQ(form.bounds.tangential.upper, 0.4);
  EXPECT_NEAR(form.bounds.normal_total_n_s.upper / form.bounds.normal_total_n_s.lower, 2.1, 1e-15);
  EXPECT_FALSE(form.coefficients.has_value());
}

// [56] and [59] at x = 0.1 and eta = 1/2: (1 - x)/2, (1 + x)/2, mu (1/3 - 2 x (1/2)/(9/4)).
TEST(NearlyVerticalTest, CoefficientsAreThoseOfThePaperToFirstOrder) {
  Problem problem = Make(4.0, 1.0, 0.4);
  problem.coefficient = 0.5;
  const NearlyVertical form = SolveNearlyVertical(problem, true);
  ASSERT_TRUE(form.coefficients.has_value());
  EXPECT_NEAR(form.coefficients->newton, 0.45, 1e-15);
  EXPECT_NEAR(*form.coefficients->poisson, 0.55, 1e-15);
  EXPECT_EQ(form.coefficients->energetic, 0.5);
  EXPECT_NEAR(form.coefficients->tangential, 0.4 * (1.0 / 3.0 - 0.1 / 2.25), 1e-15);
}

// Far from x = 0 the formulas say nothing, but |mu_hat| is at most mu.
TEST(NearlyVerticalTest, TheErrorOfBrachsRatioIsNoMoreThanItsRange) {
  Problem problem = Make(0.3, 1.0, 0.29999999999);
  problem.law = RestitutionLaw::kNewton;
  problem.coefficient = 1e-7;
  const NearlyVertical form = SolveNearlyVertical(problem, true);
  EXPECT_LE(form.coefficient_errors.tangential, 0.3 + std::fabs(form.coefficients->tangential) + 1e-15);
}

TEST(NearlyVerticalTest, OneLawFormsAreThoseOfThePaper) {
  Problem problem = Make(4.0, -1.0, 0.4);
  problem.coefficient = 0.5;
  problem.law = RestitutionLaw::kNewton;
  EXPECT_NEAR(*SolveNearlyVertical(problem, true).coefficients->poisson, 0.6, 1e-15);
  problem.law = RestitutionLaw::kPoisson;
  EXPECT_NEAR(SolveNearlyVertical(problem, true).coefficients->newton, 0.4, 1e-15);
  EXPECT_NEAR(SolveNearlyVertical(problem, true).coefficients->tangential, -0.4 / 3.0, 1e-15);
}

// |form - exact| <= error, in ball arithmetic; false if that is not certain.
bool Encloses(double form, double error, const Ball& exact) {
  if (!std::isfinite(form) || !std::isfinite(error)) return true;
  return Abs(Ball(form, 512) - exact) <= Ball(error);
}

std::vector<Problem> ProblemsWithSlip(int count, uint64_t seed) {
  SceneSource source(seed);
  std::vector<Problem> problems;
  while (problems.size() < static_cast<size_t>(count)) {
    const Problem problem = source.AnyImpact();
    const bool slips = SolveBounds(problem).regime != Regime::kLocked;
    if (slips) problems.push_back(problem);
  }
  return problems;
}

TEST(NearlyVerticalTest, ErrorsOfTheBoundsEncloseTheTrueError) {
  for (const Problem& problem : ProblemsWithSlip(kScenes, 57)) {
    const NearlyVertical form = SolveNearlyVertical(problem, false);
    const ExactCoefficientBounds exact = SolveBoundsExactly(problem).sharp;
    ASSERT_TRUE(Encloses(form.bounds.newton.upper, form.newton_error, exact.newton.upper)) << ToString(problem);
    ASSERT_TRUE(Encloses(form.bounds.poisson.upper, form.poisson_error, exact.poisson.upper)) << ToString(problem);
    ASSERT_TRUE(Encloses(form.bounds.tangential.lower, form.tangential_error, exact.tangential.lower))
        << ToString(problem);
    ASSERT_TRUE(Encloses(form.bounds.tangential.upper, form.tangential_error, exact.tangential.upper))
        << ToString(problem);
    ASSERT_TRUE(Encloses(form.bounds.normal_total_n_s.upper, form.normal_total_error_n_s, exact.normal_total.upper))
        << ToString(problem);
  }
}

TEST(NearlyVerticalTest, ErrorsOfTheCoefficientsEncloseTheTrueError) {
  for (const Problem& problem : ProblemsWithSlip(kScenes, 59)) {
    const NearlyVertical form = SolveNearlyVertical(problem, true);
    const ExactImpact exact = SolveExactly(problem);
    const Coefficients& errors = form.coefficient_errors;
    ASSERT_TRUE(Encloses(form.coefficients->newton, errors.newton, exact[Output::kNewton])) << ToString(problem);
    ASSERT_TRUE(Encloses(*form.coefficients->poisson, *errors.poisson, exact[Output::kPoisson])) << ToString(problem);
    ASSERT_TRUE(Encloses(*form.coefficients->energetic, *errors.energetic, exact[Output::kEnergetic]))
        << ToString(problem);
    ASSERT_TRUE(Encloses(form.coefficients->tangential, errors.tangential, exact[Output::kTangentialCoefficient]))
        << ToString(problem);
  }
}

// The error bounds are of second order themselves: at x = 0.01 they are of the size of x^2.
TEST(NearlyVerticalTest, ErrorsAreOfSecondOrder) {
  Problem problem = Make(4.0, 1.0, 0.04);
  problem.coefficient = 1.0;
  const NearlyVertical form = SolveNearlyVertical(problem, true);
  EXPECT_LT(form.newton_error, 0.6e-4);
  EXPECT_LT(form.poisson_error, 0.6e-4);
  EXPECT_LT(form.coefficient_errors.tangential, 0.04 * 0.2e-4);
}

}  // namespace
}  // namespace ricochet::pendulum
