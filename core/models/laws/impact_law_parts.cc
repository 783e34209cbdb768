#include "core/models/laws/impact_law_parts.h"

#include <cmath>
#include <limits>

#include "core/numerics/products.h"

namespace ricochet::laws {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

double Determinant(const PlanarProblem& in) {
  return in.w.Rank() == 2 ? DifferenceOfProducts(in.w.tt, in.w.nn, in.w.tn, in.w.tn) : 0.0;
}

// The slip after frictionless compression, times wnn. If W has rank one, velocities in its range have no such slip, so
// that a difference within the rounding of its terms counts as 0.
double FrictionlessSlip(const PlanarProblem& in, bool rank_one) {
  const double slip = DifferenceOfProducts(in.u0, in.w.nn, in.v0, in.w.tn);
  const double rounding = 8.0 * kEpsilon * (std::abs(in.u0) * in.w.nn + std::abs(in.v0 * in.w.tn));
  return rank_one && std::abs(slip) <= rounding ? 0.0 : slip;
}

// A number with more bits than a double: the sum of both parts.
struct Unrounded {
  double high;
  double low;
};

// c = -(v0 + e v0) with its rounding error, which matters in G and T, because these all but cancel near rank one.
Unrounded NormalGain(double v0, double e) {
  const double product = e * v0;
  const double product_error = std::fma(e, v0, -product);
  const double sum = v0 + product;
  const double product_part = sum - v0;
  const double sum_error = (v0 - (sum - product_part)) + (product - product_part);
  return {-sum, -(sum_error + product_error)};
}

// Computes u0 w + c w2 to a few ulp, however much cancels.
double StickingNumerator(double u0, double w, Unrounded c, double w2) {
  return std::fma(c.low, w2, DifferenceOfProducts(u0, w, -c.high, w2));
}

}  // namespace

double Sign(double x) { return static_cast<double>(x > 0.0) - static_cast<double>(x < 0.0); }

NewtonImpact::NewtonImpact(const PlanarProblem& input, double e)
    : in_(input),
      e_(e),
      c_(std::fma(-e, input.v0, -input.v0)),
      det_(Determinant(input)),
      h_(FrictionlessSlip(input, det_ == 0.0)) {
  const Unrounded gain = NormalGain(input.v0, e);
  t_ = StickingNumerator(input.u0, input.w.tn, gain, input.w.tt);
  g_ = rank_one() ? std::fma(-e * input.v0, input.w.tn, h_) : StickingNumerator(input.u0, input.w.nn, gain, input.w.tn);
}

std::optional<ImpactLawResult> NewtonImpact::Trivial() const {
  if (in_.v0 >= 0.0) return ImpactLawResult{{{.u1 = in_.u0, .v1 = in_.v0}}};
  if (in_.w.nn <= 0.0) return ImpactLawResult{};
  return std::nullopt;
}

double NewtonImpact::NormalSlope(double ratio) const { return std::fma(ratio, in_.w.tn, in_.w.nn); }

ImpactSolution NewtonImpact::Solution(double f, double tau1, double u1) const {
  const double twice_mean_v = std::fma(-e_, in_.v0, in_.v0);
  // Adding 0 makes a zero of either sign +0.
  return {.f = f + 0.0,
          .tau1 = tau1,
          .u1 = u1 + 0.0,
          .v1 = -e_ * in_.v0 + 0.0,
          .energy_change = 0.5 * DifferenceOfProducts(f, in_.u0 + u1, -tau1, twice_mean_v) + 0.0};
}

// u1 is computed from u0 rather than from G + r T, because the latter nearly cancel if dv/dtau is small.
std::optional<ImpactSolution> NewtonImpact::AtRatio(double ratio) const {
  const double slope = NormalSlope(ratio);
  if (!(slope > 0.0)) return std::nullopt;
  const double tau1 = c_ / slope;
  const double u1 = rank_one() ? g_ / in_.w.nn : std::fma(tau1, std::fma(ratio, in_.w.tt, in_.w.tn), in_.u0);
  return Solution(ratio * tau1, tau1, u1);
}

ImpactLawResult AtMostOne(const std::optional<ImpactSolution>& solution) {
  ImpactLawResult result;
  if (solution.has_value()) result.solutions.push_back(*solution);
  return result;
}

}  // namespace ricochet::laws
