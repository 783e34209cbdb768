#include "core/plan/arithmetic.h"

#include <algorithm>
#include <cmath>

namespace ricochet {
namespace {

// Every output is within 1 ulp, 2^-52 of its value. Over its scale a velocity is at most kappa_hat <= kappa, tau1 at
// most 1 + kappa, f1 and mu_hat at most max(1, kappa), any other output at most 1.
double CompensatedError(const pendulum::Impact& impact) {
  return 0x1p-51 * std::max(1.0, impact[pendulum::Output::kPoisson]);
}

template <typename Impact>
SolvedImpact<Impact> Compensated(const Impact& impact, double error, ArithmeticReason reason,
                                 const ImpactErrors& errors) {
  return {impact, {.arithmetic = Arithmetic::kCompensated, .reason = reason, .rounding_error = error}, errors};
}

template <typename Impact>
SolvedImpact<Impact> WithinTolerance(const Impact& impact, double error, const ImpactErrors& errors) {
  return {impact,
          {.arithmetic = Arithmetic::kPlain, .reason = ArithmeticReason::kWithinTolerance, .rounding_error = error},
          errors};
}

ArithmeticReason WhyNotPlain(bool proved) {
  return proved ? ArithmeticReason::kBoundTooLarge : ArithmeticReason::kSignNotProved;
}

}  // namespace

SolvedImpact<pendulum::Impact> SolveWithin(const pendulum::Problem& problem, double tolerance) {
  ArithmeticReason reason = ArithmeticReason::kZeroTolerance;
  if (tolerance > 0.0) {
    const pendulum::PlainImpact plain = pendulum::SolvePlain(problem);
    if (plain.proved && plain.relative_error <= tolerance) {
      return WithinTolerance(plain.impact, plain.relative_error, pendulum::PlainErrorsOf(problem, plain));
    }
    reason = WhyNotPlain(plain.proved);
  }
  const pendulum::Impact impact = pendulum::Solve(problem);
  return Compensated(impact, CompensatedError(impact), reason, pendulum::ErrorsOf(problem, impact));
}

SolvedImpact<planar::Impact> SolveWithin(const planar::Problem& problem, double tolerance) {
  ArithmeticReason reason = ArithmeticReason::kZeroTolerance;
  ImpactErrors numbers;
  if (tolerance > 0.0) {
    const planar::PlainImpact plain = planar::SolvePlain(problem, &numbers);
    const double error = plain.errors.Largest();
    if (plain.proved && error <= tolerance) return WithinTolerance(plain.impact, error, numbers);
    reason = WhyNotPlain(plain.proved);
  }
  planar::RoundingErrors errors;
  const planar::Impact impact = planar::Solve(problem, errors, &numbers);
  return Compensated(impact, errors.Largest(), reason, numbers);
}

double ToleranceLeft(double relative_tolerance, double neglected) {
  const double left = std::max(0.0, relative_tolerance - neglected);
  return left + neglected > relative_tolerance ? std::nextafter(left, 0.0) : left;
}

}  // namespace ricochet
