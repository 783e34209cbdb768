#include <optional>

#include "core/bounds/planar_ends.h"
#include "core/contact/delassus.h"

namespace ricochet {
namespace {

const AffineInterval kOne = 1.0;

Interval Tighter(const Interval& x, const AffineInterval& form) {
  const Interval both = Intersect(x, form.range());
  return IsEmpty(both) ? x : both;
}

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

std::optional<Slipping> MakeSlipping(const PlanarForm& form) {
  const bool forwards = form.u0.range().lower > 0.0;
  const bool backwards = form.u0.range().upper < 0.0;
  if ((!forwards && !backwards) || form.v0.range().upper >= 0.0 || form.wtt.range().lower <= 0.0) return std::nullopt;
  if (form.mu.range().lower < 0.0) return std::nullopt;
  const AffineInterval q = forwards ? form.wtn : -form.wtn;
  return Slipping{.wtt = form.wtt,
                  .q = q,
                  .wnn = form.wnn,
                  .slip = forwards ? form.u0 : -form.u0,
                  .speed = -form.v0,
                  .mu = form.mu,
                  .first = form.wnn - form.mu * q,
                  .braking = form.mu * form.wtt - q};
}

AffineInterval StickSlope(const PlanarForm& form) {
  return form.stick_slope.value_or(form.wnn - Square(form.wtn) / form.wtt);
}

// Tells whether the W of every scene counts as one of rank two.
bool HasRankTwo(const PlanarForm& form) {
  return StickSlope(form).range().lower > (Interval(kRankTolerance) * form.wnn.range()).upper;
}

// Returns nothing if some scenes stick and others do not.
std::optional<AfterStop> FindAfterStop(const PlanarForm& form, const Slipping& slipping) {
  const AffineInterval hold = form.mu_static.value_or(form.mu) * form.wtt;
  std::optional<AfterStop> after;
  if ((hold - slipping.q).range().lower >= 0.0 && (hold + slipping.q).range().lower >= 0.0) {
    after = AfterStop{StickSlope(form), slipping.q / slipping.wtt};
  } else if ((hold + slipping.q).range().upper < 0.0) {
    after = AfterStop{slipping.wnn + slipping.mu * slipping.q, -slipping.mu};
  }
  if (!after.has_value() || after->second.range().lower <= 0.0) return std::nullopt;
  return after;
}

struct Forms {
  AffineInterval newton, poisson, plastic, elastic, drag_plastic, drag_elastic;
};

Forms Sliding(const Slipping& slipping) {
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

Forms StopInRestitution(const Slipping& slipping, const AfterStop& after, const AffineInterval& stop_ratio) {
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

Forms StopInCompression(const Slipping& slipping, const AfterStop& after, const AffineInterval& ratio,
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
std::optional<Forms> FormsOf(const PlanarForm& form, const Slipping& slipping) {
  const bool never_jams = slipping.first.range().lower > 0.0;
  if (slipping.braking.range().upper <= 0.0 && never_jams) return Sliding(slipping);
  if (slipping.braking.range().lower <= 0.0 || !HasRankTwo(form)) return std::nullopt;
  const AffineInterval ratio = slipping.slip / slipping.speed;
  const AffineInterval stop_ratio = slipping.first / slipping.braking * ratio;  // 1 + sigma
  if (stop_ratio.range().lower >= 2.0) return Sliding(slipping);
  const std::optional<AfterStop> after = FindAfterStop(form, slipping);
  if (!after.has_value()) return std::nullopt;
  if (stop_ratio.range().upper <= 1.0) return StopInCompression(slipping, *after, ratio, stop_ratio);
  if (stop_ratio.range().lower < 1.0 || stop_ratio.range().upper > 2.0 || !never_jams) return std::nullopt;
  return StopInRestitution(slipping, *after, stop_ratio);
}

PlanarBox RangesOf(const PlanarForm& form) {
  PlanarBox box = {.wtt = form.wtt.range(),
                   .wtn = form.wtn.range(),
                   .wnn = form.wnn.range(),
                   .u0 = form.u0.range(),
                   .v0 = form.v0.range(),
                   .mu = AtLeast(form.mu.range(), 0.0)};
  if (form.mu_static.has_value()) box.mu_static = AtLeast(form.mu_static->range(), 0.0);
  if (form.stick_slope.has_value()) box.stick_slope = form.stick_slope->range();
  return box;
}

}  // namespace

PlanarEnds EncloseEnds(const PlanarForm& form) {
  PlanarEnds ends = EncloseEnds(RangesOf(form));
  const std::optional<Slipping> slipping = MakeSlipping(form);
  if (!slipping.has_value() || IsEmpty(ends.newton)) return ends;
  const std::optional<Forms> forms = FormsOf(form, *slipping);
  if (!forms.has_value()) return ends;
  const bool backwards = form.u0.range().upper < 0.0;
  const auto along = [&](const AffineInterval& drag) { return backwards ? drag : -drag; };
  ends.newton = Tighter(ends.newton, forms->newton);
  ends.poisson = Tighter(ends.poisson, forms->poisson);
  ends.normal_plastic = Tighter(ends.normal_plastic, forms->plastic);
  ends.normal_elastic = Tighter(ends.normal_elastic, forms->elastic);
  ends.tangential_plastic = Tighter(ends.tangential_plastic, along(forms->drag_plastic));
  ends.tangential_elastic = Tighter(ends.tangential_elastic, along(forms->drag_elastic));
  return ends;
}

}  // namespace ricochet
