#include "core/models/compliant/slide.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/models/compliant/oscillation.h"

namespace ricochet::compliant {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

SlideRates RatesOf(const SpringContact& contact, const SectionMode& mode, const ContactState& state) {
  const int side = mode.slip_side;
  SlideRates rates;
  rates.v_slope = contact.NormalSlope(side);
  rates.slip_slope = contact.SlipSlope(mode.branch, side);
  rates.u_slope = contact.wtn - side * (contact.mu * contact.wtt);
  rates.slip = std::max(0.0, contact.SlipSpeed(mode.branch, side, state));
  return rates;
}

// The normal impulse until N = 0 on the way out; NaN if it overflows.
double ImpulseToParting(const SpringContact& contact, const SectionMode& mode, const ContactState& state,
                        double v_slope) {
  const double energy = state.normal_force * state.normal_force / contact.NormalStiffness(mode.branch);
  const double square = std::fma(state.v, state.v, v_slope * energy);
  if (energy == 0.0) return 0.0;
  if (!std::isfinite(square)) return kNaN;
  return square < 0.0 ? kNever : energy / (state.v + std::sqrt(square));
}

// The normal impulse until the largest indentation so far is reached on the way in; NaN if it overflows.
double ImpulseToLargest(const SpringContact& contact, const SectionMode& mode, const ContactState& state,
                        double v_slope) {
  if (mode.IsFirstLoading()) return kNever;
  const double largest = mode.largest_normal_force;
  const double energy =
      (largest - state.normal_force) * (largest + state.normal_force) / contact.NormalStiffness(mode.branch);
  const double square = std::fma(state.v, state.v, -v_slope * energy);
  if (energy <= 0.0) return 0.0;
  if (!std::isfinite(square)) return kNaN;
  return square < 0.0 ? kNever : energy / (std::sqrt(square) - state.v);
}

void Advance(const SpringContact& contact, const SectionMode& mode, const SlideRates& rates, double step,
             const SectionEnd& end, ContactState& state) {
  const int side = mode.slip_side;
  const double stiffness = contact.NormalStiffness(mode.branch);
  const double slip_after = end.stops ? 0.0 : std::max(0.0, rates.slip + rates.slip_slope * step);
  state.friction_loss += 0.5 * contact.mu * step * (rates.slip + slip_after);
  const double v = end.turns ? 0.0 : state.v + rates.v_slope * step;
  const double force_squared =
      std::max(0.0, state.normal_force * state.normal_force - stiffness * step * (state.v + v));
  state.normal_force = end.parts ? 0.0 : end.passes_largest ? mode.largest_normal_force : std::sqrt(force_squared);
  state.spring_force = side * contact.mu * state.normal_force;
  state.tau += step;
  state.f -= side * contact.mu * step;
  if (contact.u_follows_v) {
    state.u = v * (contact.wtn / contact.wnn);
  } else if (end.stops) {
    state.u = -side * contact.mu * contact.ratio_squared * stiffness * v;
  } else {
    state.u = state.u + rates.u_slope * step;
  }
  state.v = v;
}

}  // namespace

SectionEnd Slide(const SpringContact& contact, const SectionMode& mode, PathError& error, ContactState& state) {
  const SlideRates rates = RatesOf(contact, mode, state);
  const bool turns_at_last = mode.indenting ? rates.v_slope > 0.0 : rates.v_slope < 0.0;
  const double to_turn = turns_at_last ? -state.v / rates.v_slope : kNever;
  const double to_stop = rates.slip_slope < 0.0 ? rates.slip / -rates.slip_slope : kNever;
  const double to_branch_end = mode.indenting ? ImpulseToLargest(contact, mode, state, rates.v_slope)
                                              : ImpulseToParting(contact, mode, state, rates.v_slope);
  if (std::isnan(to_branch_end) || !std::isfinite(rates.slip_slope + rates.v_slope + rates.slip)) {
    return {.overflows = true};
  }
  const double step = std::min({to_turn, to_stop, to_branch_end});
  if (step == kNever) return {.has_no_end = true};
  const double latest = step * (1.0 + 4.0 * kEps);
  SectionEnd end;
  end.stops = to_stop <= latest;
  if (to_branch_end <= step) {
    (mode.indenting ? end.passes_largest : end.parts) = true;
  } else {
    end.turns = to_turn <= latest;
  }
  const ContactState before = state;
  Advance(contact, mode, rates, step, end, state);
  error.AddSlide(mode, rates, before, state, step, end);
  return end;
}

}  // namespace ricochet::compliant
