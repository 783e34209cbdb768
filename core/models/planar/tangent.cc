#include "core/models/planar/tangent.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>

#include "core/models/planar/kernel-inl.h"
#include "core/models/planar/report-inl.h"
#include "core/models/planar_outputs-inl.h"
#include "core/numerics/dual-inl.h"
#include "core/numerics/wide.h"

namespace ricochet::planar {
namespace {

using ricochet::HWY_NAMESPACE::DoubleDouble;
using ricochet::HWY_NAMESPACE::Dual;
using ricochet::HWY_NAMESPACE::RoundedDual;

template <typename N>
HWY_NAMESPACE::Inputs<Dual<N>> InputsOf(const Problem& problem, const Direction& direction) {
  const auto dual = [](double value, double rate) { return Dual<N>(N::Exactly(value), N::Exactly(rate)); };
  HWY_NAMESPACE::Inputs<Dual<N>> in;
  in.wtt = dual(problem.w.tt, direction.w.tt);
  in.wtn = dual(problem.w.tn, direction.w.tn);
  in.wnn = dual(problem.w.nn, direction.w.nn);
  in.u0 = dual(problem.u0, direction.u0);
  in.v0 = dual(problem.v0, direction.v0);
  in.mu = dual(problem.mu, direction.mu);
  in.mu_static = dual(problem.mu_static, direction.mu_static);
  in.coefficient = dual(problem.coefficient, direction.coefficient);
  HWY_NAMESPACE::CompleteInputs(in);
  return in;
}

template <typename N>
int SignOf(const N& x) {
  return IsPositive(x) ? 1 : IsNegative(x) ? -1 : 0;
}

// True if u0 Wnn - v0 Wtn is 0 and does not stay so, beyond the rounding of a direction in doubles.
template <typename N>
bool LeavesRange(const HWY_NAMESPACE::Course<Dual<N>>& course) {
  const HWY_NAMESPACE::Inputs<Dual<N>>& in = course.in;
  if (!in.rank_one || !in.u_follows_v) return false;
  const Dual<N>& u0 = in.stated_u0;
  const double rate = Rounded((u0 * in.wnn - in.v0 * in.wtn).rate);
  const double size = std::fabs(Rounded(u0.rate * in.wnn.value)) + std::fabs(Rounded(u0.value * in.wnn.rate)) +
                      std::fabs(Rounded(in.v0.rate * in.wtn.value)) + std::fabs(Rounded(in.v0.value * in.wtn.rate));
  return std::fabs(rate) > 0x1p-40 * size;
}

template <typename N>
Tangent TangentIn(const Problem& problem, const Direction& direction) {
  using D = Dual<N>;
  const HWY_NAMESPACE::Inputs<D> in = InputsOf<N>(problem, direction);
  Tangent tangent;
  tangent.w_rank = in.rank_one ? 1 : 2;
  const auto set = [&tangent](PlanarOutput output, const RoundedDual& number) {
    tangent.value[static_cast<size_t>(output)] = number.value.value;
    tangent.rate[static_cast<size_t>(output)] = number.rate.value;
  };
  if (!IsNegative(in.v0)) {
    tangent.branch = {.regime = Regime::kSeparating};
    set(PlanarOutput::kTangentialVelocityAfter, Rounded(in.u0));
    set(PlanarOutput::kNormalVelocityAfter, Rounded(in.v0));
    return tangent;
  }
  const HWY_NAMESPACE::Course<D> course = HWY_NAMESPACE::Follow<D>(problem.law, in);
  const auto zero = RoundedDual::Constant(0.0);
  ForEachOutput(HWY_NAMESPACE::MakeNumbers(HWY_NAMESPACE::kAllParts, course), zero, zero, set);
  tangent.branch = {.regime = static_cast<Regime>(HWY_NAMESPACE::RegimeOf(course)),
                    .approaches = true,
                    .slip_before = SignOf(course.in.u0),
                    .stops = course.path.stops,
                    .sticks = course.path.stops && course.path.sticks,
                    .held = course.held,
                    .stops_in_compression = course.x.stops_in_compression,
                    .stops_in_restitution = course.x.stops_in_restitution};
  tangent.leaves_range = LeavesRange(course);
  return tangent;
}

// True if no product of a few of the numbers leaves the range of doubles.
bool IsModerate(const Problem& problem, const Direction& direction) {
  const auto fits = [](double x) { return x == 0.0 || (std::fabs(x) >= 0x1p-60 && std::fabs(x) <= 0x1p60); };
  const auto all_fit = [&fits](std::initializer_list<double> numbers) {
    return std::all_of(numbers.begin(), numbers.end(), fits);
  };
  return all_fit({problem.w.tt, problem.w.tn, problem.w.nn, problem.u0, problem.v0, problem.mu, problem.mu_static,
                  problem.coefficient, direction.w.tt, direction.w.tn, direction.w.nn, direction.u0, direction.v0,
                  direction.mu, direction.mu_static, direction.coefficient});
}

}  // namespace

Tangent TangentOf(const Problem& problem, const Direction& direction) {
  return IsModerate(problem, direction) ? TangentIn<DoubleDouble<double>>(problem, direction)
                                        : TangentIn<Wide>(problem, direction);
}

}  // namespace ricochet::planar
