#include "core/models/compliant/stick.h"

#include <array>
#include <cmath>
#include <numbers>

#include "core/models/compliant/normal_modes.h"
#include "core/models/compliant/root_search.h"

namespace ricochet::compliant {
namespace {

struct TimedEnd {
  double time = kNever;
  SectionEnd end;
};

// Returns the earliest time at which the particle may break away towards `side`.
SearchStart BreakAwayStart(const SpringContact& contact, const SectionMode& mode, const ContactState& state, int side,
                           const Frequencies& w) {
  // The impact starts at the tip of the cone, where the margin is 0.
  if (side != mode.left_cone_side) return {.at_zero = state.normal_force == 0.0};
  const double force_rate = -contact.NormalStiffness(mode.branch) * state.v;
  return {.time = (Angle(state.normal_force, force_rate / w.fast) + std::numbers::pi / 2.0) / w.fast};
}

// The side on which the stick probably ends. The other side is searched only up to there.
int LikelierSide(const SpringContact& contact, const ContactState& state) {
  const double leaning = state.spring_force != 0.0 ? state.spring_force : state.u != 0.0 ? state.u : contact.wtn;
  return leaning < 0.0 ? -1 : 1;
}

// Finds the first of three events: v = 0, and slip towards either side.
TimedEnd TurnOrBreakAway(const SpringContact& contact, const SectionMode& mode, const ContactState& state,
                         const NormalModes& modes) {
  const int likelier = LikelierSide(contact, state);
  const RootSearch turn(NormalSpeed(contact, mode, modes), modes.w);
  const std::array<RootSearch, 2> margins = {RootSearch(ConeMargin(contact, mode, modes, likelier), modes.w),
                                             RootSearch(ConeMargin(contact, mode, modes, -likelier), modes.w)};
  if (turn.overflows() || margins[0].overflows() || margins[1].overflows()) return {.end = {.overflows = true}};
  TimedEnd first = {.time = turn.First({.at_zero = mode.begins_with_v_zero}, kNever)};
  if (std::isnan(first.time)) return {.end = {.has_no_end = true}};
  first.end.turns = first.time < kNever;
  for (const int side : {likelier, -likelier}) {
    const SearchStart start = BreakAwayStart(contact, mode, state, side, modes.w);
    const double root = margins[side == likelier ? 0 : 1].First(start, first.time);
    if (std::isnan(root)) return {.end = {.has_no_end = true}};
    if (root < first.time) first = {.time = root, .end = {.breaks_away = side}};
  }
  first.end.has_no_end = first.time == kNever;
  return first;
}

// Returns the time at which N passes its largest value so far, or kNever. On the way in N rises until `event`.
double TimeOfLargest(const SpringContact& contact, const SectionMode& mode, const NormalModes& modes, double event) {
  const double largest = mode.largest_normal_force;
  const Signal force = NormalForce(contact, mode, modes);
  if (!(force.At(modes.w, event).f > largest)) return kNever;
  return RootBetween(0.0, event, 0.0, [&](double time) {
    const Value value = force.At(modes.w, time);
    return Value{.f = largest - value.f, .slope = -value.slope};
  });
}

TimedEnd FirstEvent(const SpringContact& contact, const SectionMode& mode, const ContactState& state,
                    const NormalModes& modes) {
  const TimedEnd first = TurnOrBreakAway(contact, mode, state, modes);
  if (first.end.has_no_end || first.end.overflows || !mode.indenting || mode.IsFirstLoading()) return first;
  const double passes = TimeOfLargest(contact, mode, modes, first.time);
  return passes < kNever ? TimedEnd{.time = passes, .end = {.passes_largest = true}} : first;
}

// Makes |p| = mu N by correcting N if mu > 1, and p otherwise, so that mu does not magnify the rounding.
void PutOnCone(const SpringContact& contact, int side, ContactState& state) {
  if (contact.mu > 1.0) {
    state.normal_force = std::fabs(state.spring_force) / contact.mu;
  } else {
    state.spring_force = side * contact.mu * state.normal_force;
  }
}

void Advance(const SpringContact& contact, const SectionMode& mode, const NormalModes& modes, const TimedEnd& event,
             const Phase& phase, ContactState& state) {
  const double ratio = std::sqrt(contact.ratio_squared);
  const double root = contact.RootOfStiffness(mode.branch);
  const auto [y, rate] = modes.At(phase);
  std::array<double, 2> integral = {};
  for (size_t i = 0; i < 2; ++i) integral[i] = modes.y[i] * phase.s[i] + modes.rate[i] * phase.s_integral[i];
  state.normal_force = event.end.passes_largest ? mode.largest_normal_force : root * (modes.s * y[0] + modes.c * y[1]);
  state.spring_force = (modes.c * y[0] - modes.s * y[1]) / ratio;
  if (event.end.breaks_away != 0) PutOnCone(contact, event.end.breaks_away, state);
  state.v = event.end.turns ? 0.0 : -(modes.s * rate[0] + modes.c * rate[1]) / root;
  state.u =
      contact.u_follows_v ? state.v * (contact.wtn / contact.wnn) : ratio * (modes.c * rate[0] - modes.s * rate[1]);
  state.tau += root * (modes.s * integral[0] + modes.c * integral[1]);
  state.f -= (modes.c * integral[0] - modes.s * integral[1]) / ratio;
}

// A stick that breaks away has no normal force left, up to rounding, at the tip of the cone.
void SettleOnCone(const SectionMode& mode, SectionEnd& end, ContactState& state) {
  // At the tip of a steep cone both sides break away at once, as far as doubles can tell. The sign of p decides.
  if (end.breaks_away * state.spring_force < 0.0) end.breaks_away = -end.breaks_away;
  end.parts = !mode.indenting && state.normal_force <= 8.0 * kEps * mode.largest_normal_force;
  if (end.parts) state.normal_force = 0.0;
}

}  // namespace

SectionEnd Stick(const SpringContact& contact, const SectionMode& mode, PathError& error, ContactState& state) {
  const NormalModes modes = MakeNormalModes(contact, mode, state);
  const TimedEnd event = FirstEvent(contact, mode, state, modes);
  SectionEnd end = event.end;
  if (end.has_no_end || end.overflows) return end;
  const Phase phase = modes.w.At(event.time);
  const ContactState before = state;
  Advance(contact, mode, modes, event, phase, state);
  if (end.breaks_away != 0) SettleOnCone(mode, end, state);
  error.AddStick(mode, modes, phase, event.time, before, state, end);
  return end;
}

bool IsHeldForEver(const SpringContact& contact, const SectionMode& mode, const ContactState& state) {
  const bool may_hold = contact.u_follows_v && mode.Sticks() && !mode.IsFirstLoading() &&
                        contact.mu * std::fabs(contact.wtn) >= contact.wnn;
  if (!may_hold) return false;
  const NormalModes modes = MakeNormalModes(contact, mode, state);
  const auto amplitude = [&modes](const Signal& signal) {
    const double sine = signal.b[0] / modes.w.fast;
    return std::sqrt(signal.a[0] * signal.a[0] + sine * sine);
  };
  const double rounding = 16.0 * kEps * mode.largest_normal_force;
  const Signal force = NormalForce(contact, mode, modes);
  if (!(force.a[1] + amplitude(force) <= mode.largest_normal_force + rounding)) return false;
  for (const int side : {-1, 1}) {
    const Signal margin = ConeMargin(contact, mode, modes, side);
    if (!(margin.a[1] - amplitude(margin) >= -contact.mu * rounding)) return false;
  }
  return true;
}

}  // namespace ricochet::compliant
