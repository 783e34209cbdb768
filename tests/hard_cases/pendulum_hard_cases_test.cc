// The pendulum where its formulas cancel, overflow or change sides, against the formulas in ball arithmetic.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/bounds/pendulum_bounds.h"
#include "core/models/pendulum/pendulum.h"
#include "core/models/restitution_law.h"
#include "tests/hard_cases/hard_case_table.h"
#include "tests/support/oracles/pendulum_oracle.h"
#include "tests/support/scenes/pendulum_scenes.h"

namespace ricochet::pendulum {
namespace {

constexpr double kPromisedUlps = 1.0;  // core/models/pendulum/pendulum.h, core/bounds/pendulum_bounds.h
constexpr double kLeast = std::numeric_limits<double>::denorm_min();

struct HardCase {
  const char* name;
  const char* why;
  std::vector<Problem> problems;
};

// The paper's formulas as they are printed, in doubles.
Impact NaiveSolve(const Problem& p) {
  const double q = p.mu * std::fabs(p.b);
  const double r = (p.a - q) / (p.a + q);
  const double sign = p.b > 0.0 ? 1.0 : p.b < 0.0 ? -1.0 : 0.0;
  Impact impact;
  const bool locks = p.mu_static * std::fabs(p.b) >= p.a;
  impact.regime = locks ? Regime::kLocked : q == 0.0 ? Regime::kFrictionless : Regime::kRebound;
  const double c = locks ? 0.0 : p.coefficient;
  double newton = c, poisson = c, eta = c;
  if (p.law == RestitutionLaw::kNewton && !locks) poisson = c / r, eta = std::sqrt(newton * poisson);
  if (p.law == RestitutionLaw::kPoisson && !locks) newton = c * r, eta = std::sqrt(newton * poisson);
  if (p.law == RestitutionLaw::kEnergetic && !locks) newton = c * std::sqrt(r), poisson = c * std::sqrt(1.0 / r);
  const double tau0 = -p.inertia * p.omega_minus / (p.a + q);
  const double tau1 = (1.0 + poisson) * tau0;
  const double omega = -newton * p.omega_minus;
  const double f1 = sign * p.mu * (2.0 * tau0 - tau1);
  const double wc_n = 0.5 * p.a * tau0 * p.omega_minus;
  const double wr_n = 0.5 * p.a * (tau1 - tau0) * omega;
  const double wc_t = 0.5 * q * tau0 * p.omega_minus;
  const double wr_t = -0.5 * q * (tau1 - tau0) * omega;
  const double lost = 0.5 * p.inertia * (p.omega_minus * p.omega_minus - omega * omega);
  impact.values = {
      newton, poisson, eta,  f1 / tau1, omega,       p.b * omega, p.a * omega, tau0,     tau1, f1, sign * p.mu * tau0,
      wc_n,   wr_n,    wc_t, wr_t,      wc_n + wr_n, wc_t + wr_t, -lost,       eta - 1.0};
  return impact;
}

double WorstError(const Problem& problem, const Impact& impact) {
  const ExactImpact exact = SolveExactly(problem);
  if (impact.regime != exact.regime) return kOtherRegime;
  double worst = 0.0;
  for (size_t i = 0; i < kOutputCount; ++i) {
    if (std::isnan(impact.values[i])) return std::numeric_limits<double>::quiet_NaN();
    worst = std::max(worst, OutputError(exact, i, impact.values[i]));
  }
  return worst;
}

// A wrong regime counts as worse than NaN, and NaN as worse than any number.
double Worse(double x, double y) {
  if (x == kOtherRegime || y == kOtherRegime) return kOtherRegime;
  if (std::isnan(x) || std::isnan(y)) return std::numeric_limits<double>::quiet_NaN();
  return std::max(x, y);
}

HardCaseResult ResultOf(const HardCase& hard) {
  HardCaseResult result = {.name = hard.name, .why = hard.why, .promised = kPromisedUlps};
  for (const Problem& problem : hard.problems) {
    const double seen = WorstError(problem, Solve(problem));
    result.seen = std::max(result.seen, seen == kOtherRegime ? std::numeric_limits<double>::infinity() : seen);
    result.naive = Worse(result.naive, WorstError(problem, NaiveSolve(problem)));
  }
  return result;
}

Problem Tip(double mu, RestitutionLaw law = RestitutionLaw::kEnergetic, double coefficient = 0.8) {
  return {.inertia = 1.2,
          .a = 0.3,
          .b = 0.7,
          .omega_minus = -2.0,
          .mu = mu,
          .mu_static = mu,
          .law = law,
          .coefficient = coefficient};
}

constexpr std::array kLaws = {RestitutionLaw::kNewton, RestitutionLaw::kPoisson, RestitutionLaw::kEnergetic};

double Steps(double x, int steps) {
  for (; steps > 0; --steps) x = std::nextafter(x, std::numeric_limits<double>::infinity());
  for (; steps < 0; ++steps) x = std::nextafter(x, -std::numeric_limits<double>::infinity());
  return x;
}

// `a` lies this many ulp from the rounded product mu |b|.
std::vector<Problem> UlpsFromLocking(int first, int last) {
  std::vector<Problem> problems;
  for (const RestitutionLaw law : kLaws) {
    for (int ulps = first; ulps <= last; ++ulps) {
      for (const double mu : {0.37, 0.41, 0.43}) {
        Problem problem = Tip(mu, law);
        problem.a = Steps(mu * problem.b, ulps);
        problems.push_back(problem);
      }
    }
  }
  return problems;
}

std::vector<Problem> FrictionOneUlpFromLocking() {
  std::vector<Problem> problems;
  for (const RestitutionLaw law : kLaws) {
    for (const int ulps : {-1, 0, 1}) problems.push_back(Tip(Steps(0.3 / 0.7, ulps), law));
  }
  return problems;
}

// x = 1e-300, 1e-290, ..., 1e-10, 0.1, 0.5 and the last below 1.
std::vector<double> FrictionRatios() {
  std::vector<double> ratios = {0.1, 0.5, 1.0 - 0x1p-50};
  for (int power = -300; power < 0; power += 10)
    ratios.push_back(std::strtod(("1e" + std::to_string(power)).c_str(), nullptr));
  return ratios;
}

std::vector<Problem> AllFrictionRatios(double coefficient) {
  std::vector<Problem> problems;
  for (const double x : FrictionRatios()) {
    for (const RestitutionLaw law : kLaws) problems.push_back(Tip(x * (0.3 / 0.7), law, coefficient));
  }
  return problems;
}

// The coefficient at 1 -+ 2^-k times a critical one of each law.
std::vector<Problem> NearCoefficients(double newton, double poisson, double energetic, std::vector<double> sides) {
  std::vector<Problem> problems;
  for (const double side : sides) {
    for (int k = 1; k <= 53; ++k) {
      const double factor = 1.0 + side * std::ldexp(1.0, -k);
      if (newton > 0.0) problems.push_back(Tip(0.1, RestitutionLaw::kNewton, newton * factor));
      if (poisson > 0.0) problems.push_back(Tip(0.1, RestitutionLaw::kPoisson, poisson * factor));
      if (energetic > 0.0) problems.push_back(Tip(0.1, RestitutionLaw::kEnergetic, energetic * factor));
    }
  }
  return problems;
}

std::vector<Problem> Elastic() {
  std::vector<Problem> problems;
  for (const double mu : {0.0, 0x1p-60, 0.1, 0.25, 0.4}) problems.push_back(Tip(mu, RestitutionLaw::kEnergetic, 1.0));
  return problems;
}

std::vector<Problem> Vertical() {
  std::vector<Problem> problems;
  for (const RestitutionLaw law : kLaws) {
    for (const double b : {0.0, -0.0}) {
      problems.push_back(Tip(0.5, law));
      problems.back().b = b;
    }
  }
  return problems;
}

Problem Scaled(double inertia, double lengths, double omega, double mu) {
  return {.inertia = 1.2 * inertia,
          .a = 0.3 * lengths,
          .b = 0.7 * lengths,
          .omega_minus = -2.0 * omega,
          .mu = mu,
          .mu_static = mu,
          .coefficient = 0.8};
}

std::vector<Problem> HugeAndTiny() {
  std::vector<Problem> problems = {Scaled(1e300, 1.0, 1e-300, 0.1), Scaled(1e-300, 1.0, 1e300, 0.1),
                                   Scaled(1.0, 1e300, 1.0, 0.1), Scaled(1.0, 1e-300, 1.0, 0.1),
                                   Scaled(1e300, 1e300, 1e-200, 0.1)};
  problems.push_back({.inertia = 1.0,
                      .a = 1e300,
                      .b = 1e-300,
                      .omega_minus = -1.0,
                      .mu = 1e300,
                      .mu_static = 1e300,
                      .coefficient = 1.0});
  problems.push_back({.inertia = 1e-300,
                      .a = 1e-300,
                      .b = 1e300,
                      .omega_minus = -1e300,
                      .mu = 1e-300,
                      .mu_static = 1e-300,
                      .coefficient = 1.0});
  return problems;
}

std::vector<Problem> Subnormal() {
  return {Scaled(kLeast, 1.0, 1.0, 0.1), Scaled(1.0, 1.0, 0x1p-1070, 0.1), Scaled(0x1p-1060, 0x1p-1060, 1.0, 0.1),
          Scaled(1.0, 0x1p-1030, 0x1p-30, 0x1p-20), Scaled(1.0, 1.0, 1.0, kLeast)};
}

std::vector<Problem> LockedByStaticFriction() {
  std::vector<Problem> problems;
  for (const int ulps : {0, 1, 3}) {
    problems.push_back(Tip(0.4));
    problems.back().mu_static = Steps(0.3 / 0.7, ulps);
  }
  return problems;
}

std::vector<HardCase> HardCases() {
  const double x = 0.1 * 0.7 / 0.3;
  const double r = (1.0 - x) / (1.0 + x);
  return {
      {"a − μ\\|b\\| 1 to 40 ulp above 0", "its last bits are those of a rounded product", UlpsFromLocking(1, 40)},
      {"a − μ\\|b\\| 1 to 40 ulp below 0", "its last bits are those of a rounded product; locked",
       UlpsFromLocking(-40, -1)},
      {"a − μ\\|b\\| less than an ulp", "the rounded product is a itself: the sign is in what was lost",
       UlpsFromLocking(0, 0)},
      {"μ within an ulp of a/b", "the quotient is rounded: on which side is 1?", FrictionOneUlpFromLocking()},
      {"x from 10⁻³⁰⁰ to 1, elastic", "κ − 1 is of the order of x", AllFrictionRatios(1.0)},
      {"x from 10⁻³⁰⁰ to 1, η = 0.8", "r is 1 − 2x", AllFrictionRatios(0.8)},
      {"η = 1 − 2⁻ᵏ, k to 53", "1 − η² is what deformation takes", NearCoefficients(0.0, 0.0, 1.0, {-1.0})},
      {"κ̂ or κ within 2⁻ᵏ of η = 1", "1 − κκ̂ of rounded κκ̂",
       NearCoefficients(std::sqrt(r), std::sqrt(1.0 / r), 0.0, {-1.0, 1.0})},
      {"η = 1", "no work is lost to deformation, exactly", Elastic()},
      {"κ within 2⁻ᵏ of 1", "the friction impulse and μ̂ change sign",
       NearCoefficients(r, 1.0, std::sqrt(r), {-1.0, 1.0})},
      {"κ̂ within 2⁻ᵏ of 1", "energy is created beyond", NearCoefficients(1.0, 1.0 / r, 0.0, {-1.0, 1.0})},
      {"b = 0 and b = −0", "a limit, and signs of zeros", Vertical()},
      {"inputs at 10^±300", "squares and products leave the range", HugeAndTiny()},
      {"subnormal inputs and outputs", "fewer bits, and none to lose twice", Subnormal()},
      {"locked by μ_s one ulp above a/b", "μ itself would let it rebound", LockedByStaticFriction()},
  };
}

// In the bounds of [55] and [31], 1 - sqrt(1 - x^2) cancels at both ends of x.
HardCaseResult RunBounds() {
  HardCaseResult result = {.name = "bounds, x from 10⁻³⁰⁰ to 1", .why = "1 − √(1 − x²)", .promised = kPromisedUlps};
  for (const double ratio : FrictionRatios()) {
    const Problem p = Tip(ratio * (0.3 / 0.7));
    const ExactCoefficientBounds exact = SolveBoundsExactly(p).sharp;
    const CoefficientBounds bounds = SolveBounds(p).sharp;
    const double x = p.mu * p.b / p.a;
    const double naive_kappa = std::sqrt((p.a + p.mu * p.b) / (p.a - p.mu * p.b));
    const double naive_least = -(p.a / p.b) * (1.0 - std::sqrt(1.0 - x * x));
    result.seen = std::max({result.seen, ErrorInUlps(bounds.tangential.lower, exact.tangential.lower),
                            ErrorInUlps(bounds.poisson.upper, exact.poisson.upper),
                            ErrorInUlps(bounds.newton.upper, exact.newton.upper)});
    result.naive = std::max({result.naive, ErrorInUlps(naive_least, exact.tangential.lower),
                             ErrorInUlps(naive_kappa, exact.poisson.upper)});
  }
  return result;
}

// The model's header grants outputs of the order of x an error of 2^-100 of their scale; here they are held to their
// own last digits.
HardCaseResult RunOwnDigits() {
  constexpr double kLeastRatio = 1e-55;  // Below this ratio the reference would need more bits than it has.
  HardCaseResult result = {.name = "coefficients of 1, x from 10⁻⁵⁰ to 1: what changes sign there, by its own size",
                           .why = "a − q and a + q differ by less than 2⁻¹⁰⁶",
                           .promised = kPromisedUlps};
  for (const double ratio : FrictionRatios()) {
    if (ratio < kLeastRatio) continue;
    for (const RestitutionLaw law : kLaws) {
      const Problem problem = Tip(ratio * (0.3 / 0.7), law, 1.0);
      const ExactImpact exact = SolveExactly(problem);
      const Impact impact = Solve(problem);
      const Impact naive = NaiveSolve(problem);
      for (const Output output : {Output::kTangentialCoefficient, Output::kTangentialImpulse, Output::kWorkNormal,
                                  Output::kEnergyChange, Output::kEnergeticExcess}) {
        const Ball& value = exact.values[static_cast<size_t>(output)];
        if (value.ContainsZero() && impact[output] == 0.0) continue;
        result.seen = std::max(result.seen, ErrorInUlps(impact[output], value));
        result.naive = std::max(result.naive, ErrorInUlps(naive[output], value));
      }
    }
  }
  return result;
}

TEST(PendulumHardCasesTest, KeepTheirPromise) {
  std::vector<HardCaseResult> results;
  for (const HardCase& hard : HardCases()) results.push_back(ResultOf(hard));
  results.push_back(RunOwnDigits());
  results.push_back(RunBounds());
  CheckTable("pendulum", "ulp", results);
}

// `a` is the rounded product mu_s |b|, from which the exact one differs to either side.
std::vector<Problem> StaticFrictionLessThanAnUlpFromLocking() {
  std::vector<Problem> problems;
  for (int i = 0; i < 20; ++i) {
    problems.push_back(Tip(0.3));
    problems.back().mu_static = 0.4 + 0.01 * i;
    problems.back().a = problems.back().mu_static * problems.back().b;
  }
  return problems;
}

// Problems whose regime or limits a rounded sign gets wrong.
std::vector<Problem> NearThresholds() {
  const double x = 0.1 * 0.7 / 0.3;
  const double r = (1.0 - x) / (1.0 + x);
  std::vector<Problem> problems;
  for (const auto& near : {UlpsFromLocking(-40, 40), FrictionOneUlpFromLocking(), LockedByStaticFriction(),
                           StaticFrictionLessThanAnUlpFromLocking(), Elastic(), Vertical(),
                           NearCoefficients(std::sqrt(r), std::sqrt(1.0 / r), 0.0, {-1.0, 1.0}),
                           NearCoefficients(0.0, 0.0, 1.0, {-1.0}), NearCoefficients(1.0, 1.0 / r, 0.0, {-1.0, 1.0})}) {
    problems.insert(problems.end(), near.begin(), near.end());
  }
  return problems;
}

bool HasVerdictsOf(const ExactImpact& exact, const Impact& impact) {
  return impact.regime == exact.regime && impact.sharp_limit_broken == exact.sharp_limit_broken &&
         impact.energy_limit_broken == exact.energy_limit_broken;
}

TEST(PendulumHardCasesTest, PlainArithmeticDecidesNothingByARoundedSign) {
  int proved = 0;
  int left_open = 0;
  for (const Problem& problem : NearThresholds()) {
    const PlainImpact plain = SolvePlain(problem);
    ++(plain.proved ? proved : left_open);
    EXPECT_TRUE(!plain.proved || HasVerdictsOf(SolveExactly(problem), plain.impact)) << ToString(problem);
  }
  // Only what lies within a few ulp of a limit is left to the arithmetic that is more exact.
  EXPECT_GT(proved, 1000);
  EXPECT_GT(left_open, 10);
  EXPECT_LT(left_open, 80);
}

TEST(PendulumHardCasesTest, ZerosAndOnesAreExact) {
  for (const Problem& problem : Elastic()) {
    const Impact impact = Solve(problem);
    EXPECT_EQ(impact[Output::kWorkNormal], 0.0);
    EXPECT_EQ(impact[Output::kEnergeticExcess], 0.0);
    EXPECT_EQ(impact[Output::kEnergetic], 1.0);
  }
  for (const Problem& problem : Vertical()) {
    const Impact impact = Solve(problem);
    EXPECT_EQ(impact.regime, Regime::kFrictionless);
    EXPECT_EQ(impact[Output::kTangentialImpulse], 0.0);
    EXPECT_EQ(impact[Output::kNewton], 0.8);
  }
}

}  // namespace
}  // namespace ricochet::pendulum
