#include <optional>

#include "core/bounds/planar_ends.h"
#include "core/contact/delassus.h"

namespace ricochet {
namespace {

const AffineInterval kOne = 1.0;

// A contact whose slip starts in one direction. Tangential numbers are stated along that direction;
// docs/theory/bounds.md has the slopes.
struct Slipping {
  AffineInterval wtt, q, wnn, slip, speed, mu;
  AffineInterval first;    // A1
  AffineInterval braking;  // B
};

// The path after slip has stopped.
struct AfterStop {
  AffineInterval second;  // A2
  AffineInterval drag;    // -f'
};

std::optional<Slipping> MakeSlipping(const AffinePlanarBox& box) {
  const bool forwards = box.u0.range().lower > 0.0;
  const bool backwards = box.u0.range().upper < 0.0;
  if ((!forwards && !backwards) || box.v0.range().upper >= 0.0 || box.wtt.range().lower <= 0.0) return std::nullopt;
  if (box.mu.range().lower < 0.0) return std::nullopt;
  const AffineInterval q = forwards ? box.wtn : -box.wtn;
  return Slipping{.wtt = box.wtt,
                  .q = q,
                  .wnn = box.wnn,
                  .slip = forwards ? box.u0 : -box.u0,
                  .speed = -box.v0,
                  .mu = box.mu,
                  .first = box.wnn - box.mu * q,
                  .braking = box.mu * box.wtt - q};
}

AffineInterval StickSlope(const AffinePlanarBox& box) {
  return box.stick_slope.value_or(box.wnn - Square(box.wtn) / box.wtt);
}

// Tells whether the W of every scene counts as one of rank two.
bool HasRankTwo(const AffinePlanarBox& box) {
  return StickSlope(box).range().lower > (Interval(kRankTolerance) * box.wnn.range()).upper;
}

// Returns nothing if some scenes stick and others do not.
std::optional<AfterStop> FindAfterStop(const AffinePlanarBox& box, const Slipping& slipping) {
  const AffineInterval hold = box.mu_static.value_or(box.mu) * box.wtt;
  std::optional<AfterStop> after;
  if ((hold - slipping.q).range().lower >= 0.0 && (hold + slipping.q).range().lower >= 0.0) {
    after = AfterStop{StickSlope(box), slipping.q / slipping.wtt};
  } else if ((hold + slipping.q).range().upper < 0.0) {
    after = AfterStop{slipping.wnn + slipping.mu * slipping.q, -slipping.mu};
  }
  if (!after.has_value() || after->second.range().lower <= 0.0) return std::nullopt;
  return after;
}

// Newton's and Poisson's coefficient, the normal impulses and the mean drag for a plastic and an elastic impact.
struct AffineEnds {
  AffineInterval newton, poisson, plastic, elastic, drag_plastic, drag_elastic;
};

AffineEnds Sliding(const Slipping& slipping) {
  const AffineInterval compression = slipping.speed / slipping.first;
  return {.newton = kOne,
          .poisson = kOne,
          .plastic = compression,
          .elastic = compression + compression,
          .drag_plastic = slipping.mu,
          .drag_elastic = slipping.mu};
}

// Returns the mean of -f' over an impulse of which slip takes the share `share`.
AffineInterval Blend(const Slipping& slipping, const AfterStop& after, const AffineInterval& share) {
  return after.drag + share * (slipping.mu - after.drag);
}

AffineEnds StopInRestitution(const Slipping& slipping, const AfterStop& after, const AffineInterval& stop_ratio) {
  const AffineInterval sigma = Within(stop_ratio - kOne, {0.0, 1.0});
  const AffineInterval rho = after.second / slipping.first;
  const AffineInterval square = Square(sigma);
  const AffineInterval newton = Sqrt(square + rho * (kOne - square));
  const AffineInterval poisson = (kOne + sigma * newton) / (sigma + newton);
  const AffineInterval compression = slipping.speed / slipping.first;
  return {.newton = newton,
          .poisson = poisson,
          .plastic = compression,
          .elastic = compression * (kOne + poisson),
          .drag_plastic = slipping.mu,
          .drag_elastic = Blend(slipping, after, (sigma + newton) / (kOne + newton))};
}

AffineEnds StopInCompression(const Slipping& slipping, const AfterStop& after, const AffineInterval& ratio,
                             const AffineInterval& stop_ratio) {
  const AffineInterval m = Within(kOne - stop_ratio, {0.0, rounding::kInfinity});
  const AffineInterval h = after.second * ratio / slipping.braking;
  const AffineInterval compression_end = h + m;  // A2 tau_c/w
  const AffineInterval newton = Sqrt(h * (kOne + m) + Square(m));
  const AffineInterval poisson = newton / compression_end;
  const AffineInterval scale = slipping.speed / after.second;
  return {.newton = newton,
          .poisson = poisson,
          .plastic = scale * compression_end,
          .elastic = scale * (compression_end + newton),
          .drag_plastic = Blend(slipping, after, h / compression_end),
          .drag_elastic = Blend(slipping, after, h / (compression_end + newton))};
}

// Returns nothing if the scenes of the box may go different ways.
std::optional<AffineEnds> EndsOf(const AffinePlanarBox& box, const Slipping& slipping) {
  const bool never_jams = slipping.first.range().lower > 0.0;
  if (slipping.braking.range().upper <= 0.0 && never_jams) return Sliding(slipping);
  if (slipping.braking.range().lower <= 0.0 || !HasRankTwo(box)) return std::nullopt;
  const AffineInterval ratio = slipping.slip / slipping.speed;
  const AffineInterval stop_ratio = slipping.first / slipping.braking * ratio;  // 1 + sigma
  if (stop_ratio.range().lower >= 2.0) return Sliding(slipping);
  const std::optional<AfterStop> after = FindAfterStop(box, slipping);
  if (!after.has_value()) return std::nullopt;
  if (stop_ratio.range().upper <= 1.0) return StopInCompression(slipping, *after, ratio, stop_ratio);
  if (stop_ratio.range().lower < 1.0 || stop_ratio.range().upper > 2.0 || !never_jams) return std::nullopt;
  return StopInRestitution(slipping, *after, stop_ratio);
}

PlanarBox RangesOf(const AffinePlanarBox& box) {
  PlanarBox ranges = {.wtt = box.wtt.range(),
                      .wtn = box.wtn.range(),
                      .wnn = box.wnn.range(),
                      .u0 = box.u0.range(),
                      .v0 = box.v0.range(),
                      .mu = AtLeast(box.mu.range(), 0.0)};
  if (box.mu_static.has_value()) ranges.mu_static = AtLeast(box.mu_static->range(), 0.0);
  if (box.stick_slope.has_value()) ranges.stick_slope = box.stick_slope->range();
  return ranges;
}

}  // namespace

PlanarEnds EncloseEnds(const AffinePlanarBox& box) {
  PlanarEnds ends = EncloseEnds(RangesOf(box));
  const std::optional<Slipping> slipping = MakeSlipping(box);
  if (!slipping.has_value() || IsEmpty(ends.newton)) return ends;
  const std::optional<AffineEnds> tighter = EndsOf(box, *slipping);
  if (!tighter.has_value()) return ends;
  const bool backwards = box.u0.range().upper < 0.0;
  const auto along = [&](const AffineInterval& drag) { return (backwards ? drag : -drag).range(); };
  ends.newton = Both(ends.newton, tighter->newton.range());
  ends.poisson = Both(ends.poisson, tighter->poisson.range());
  ends.normal_plastic = Both(ends.normal_plastic, tighter->plastic.range());
  ends.normal_elastic = Both(ends.normal_elastic, tighter->elastic.range());
  ends.tangential_plastic = Both(ends.tangential_plastic, along(tighter->drag_plastic));
  ends.tangential_elastic = Both(ends.tangential_elastic, along(tighter->drag_elastic));
  return ends;
}

}  // namespace ricochet
