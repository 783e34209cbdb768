
#include "core/bounds/planar_ends.h"

namespace ricochet {
namespace {

// Returns the hull of a monotone function's values, which it takes at both ends.
template <typename Function>
Interval AtEnds(const Interval& x, Function function) {
  return Hull(function(Interval(x.lower)), function(Interval(x.upper)));
}

// Returns |w-| for the scenes that approach.
Interval ApproachRate(const PendulumBox& box) {
  if (box.a.lower >= 0.0) return AtLeast(-box.omega_minus, 0.0);
  if (box.a.upper <= 0.0) return AtLeast(box.omega_minus, 0.0);
  return Abs(box.omega_minus);
}

}  // namespace

Interval OnItsSide(const Interval& ahead, const Interval& slope) {
  Interval sides = kNothing;
  if (slope.upper > 0.0) sides = Hull(sides, ahead);
  if (slope.lower < 0.0) sides = Hull(sides, -ahead);
  if (Contains(slope, 0.0)) sides = Hull(sides, 0.0);
  return sides;
}

PlanarEnds EncloseEnds(const PendulumBox& box) {
  PlanarEnds ends;
  if (IsEmpty(box.a) || IsEmpty(box.mu) || (box.mu_static && box.mu_static->upper < box.mu.lower)) return ends;
  const Interval approach = -(box.a * box.omega_minus);
  if (approach.lower <= 0.0) ends.normal_plastic = ends.normal_elastic = 0.0;
  if (approach.upper <= 0.0) return ends;

  const Interval one(1.0);
  const Interval lever = Abs(box.a);
  const Interval depth = Abs(box.b);
  const Interval mu_static = AtLeast(box.mu_static.value_or(box.mu), box.mu.lower);
  const Interval momentum = box.inertia * ApproachRate(box);
  const Interval q = box.mu * depth;
  const Interval slope = box.slope.value_or(box.b / box.a);
  const Interval steepness = Intersect(Abs(slope), AtLeast(depth / lever, 0.0));
  const Interval plastic = Intersect(momentum / (lever + q), momentum / (lever * (one + box.mu * steepness)));
  const Interval hold = mu_static * steepness - one;
  ends.tangential_plastic = OnItsSide(box.mu, slope);
  ends.normal_plastic = Hull(ends.normal_plastic, plastic);
  if (hold.upper >= 0.0) {
    ends.newton = ends.poisson = ends.energetic = 0.0;
    ends.tangential_elastic = ends.tangential_plastic;
    ends.normal_elastic = Hull(ends.normal_elastic, plastic);
  }
  if (hold.lower >= 0.0) return ends;

  // The rest is for the scenes that slip, which have x = mu |b|/a < mu/mu_s <= 1.
  Interval x = AtMost(AtLeast(box.mu * steepness, 0.0), 1.0);
  if (mu_static.lower > 0.0) x = AtMost(x, (box.mu / mu_static).upper);
  if (IsEmpty(x)) return ends;
  const Interval newton = AtEnds(x, [&](const Interval& at) { return Sqrt(AtLeast((one - at) / (one + at), 0.0)); });
  const Interval poisson = one / newton;
  const Interval elastic =
      AtEnds(x, [&](const Interval& at) { return -(at / (one + Sqrt(AtLeast((one - at) * (one + at), 0.0)))); });
  const Interval root = Sqrt(AtLeast((lever - q) * (lever + q), 0.0));
  ends.newton = Hull(ends.newton, newton);
  ends.poisson = Hull(ends.poisson, poisson);
  ends.energetic = Hull(ends.energetic, 1.0);
  ends.tangential_elastic = Hull(ends.tangential_elastic, OnItsSide(box.mu * elastic, slope));
  ends.normal_elastic = Hull(ends.normal_elastic, Intersect(plastic * (one + poisson), plastic + momentum / root));
  return ends;
}

}  // namespace ricochet
