#include "core/models/compliant/path.h"

#include <limits>
#include <optional>

#include "core/models/compliant/section.h"
#include "core/models/compliant/slide.h"
#include "core/models/compliant/stick.h"

namespace ricochet::compliant {
namespace {

FrictionState FrictionOf(const SectionMode& mode) {
  if (mode.Sticks()) return FrictionState::kStick;
  return mode.slip_side > 0 ? FrictionState::kSlideForward : FrictionState::kSlideBackward;
}

class PathFollower {
 public:
  PathFollower(const SpringContact& contact, double u0, double v0, std::vector<Section>& sections)
      : contact_(contact), error_(contact), sections_(sections) {
    state_.u = contact.u_follows_v ? v0 * (contact.wtn / contact.wnn) : u0;
    state_.v = v0;
    mode_.slip_side = SlipSideAtStart();
  }

  PathResult Follow() {
    PathResult result;
    result.termination = FollowToEnd();
    result.end = state_;
    constexpr double kUnknown = std::numeric_limits<double>::infinity();
    result.u_error = result.Ends() ? error_.OfU() : kUnknown;
    result.v_error = result.Ends() ? error_.OfV() : kUnknown;
    const bool is_known = compressions_ > 0 && !has_tie_;
    result.compression_force_error = is_known ? compression_force_error_ : kUnknown;
    result.compression_u_error = is_known ? compression_u_error_ : kUnknown;
    result.sections = error_.sections();
    result.compression_end = mode_.IsFirstLoading() ? state_ : compression_end_;
    result.largest_normal_force = mode_.IsFirstLoading() ? state_.normal_force : mode_.largest_normal_force;
    if (!compressions_before_stick_.has_value()) return result;
    const bool in_compression = mode_.IsFirstLoading() || *compressions_before_stick_ < compressions_;
    result.first_stick = in_compression ? FirstStick::kInCompression : FirstStick::kInRestitution;
    return result;
  }

 private:
  int SlipSideAtStart() const {
    if (contact_.mu == 0.0) return (state_.u != 0.0 ? state_.u : contact_.wtn) < 0.0 ? -1 : 1;
    const int side = state_.u < 0.0 ? -1 : 1;
    const double speed = contact_.SlipSpeedAtStart(side, state_);
    const bool slides = speed > 0.0 || (speed == 0.0 && contact_.SlipSlope(mode_.branch, side) >= 0.0);
    return slides ? side : 0;
  }

  Termination FollowToEnd() {
    for (int i = 0; i < kMaxSections; ++i) {
      Record();
      const SectionEnd end = RunSection();
      if (end.overflows || !state_.IsFinite()) {
        state_.u = state_.v = std::numeric_limits<double>::quiet_NaN();
        return Termination::kRefused;
      }
      if (end.has_no_end) return Termination::kRefused;
      if (end.parts) return Termination::kConverged;
      if (!BeginNextSection(end)) {
        error_.EndAtRest(mode_, state_);
        return Termination::kConverged;
      }
    }
    return Termination::kBudgetUsedUp;
  }

  SectionEnd RunSection() {
    if (IsHeldForEver(contact_, mode_, state_)) return {.has_no_end = true};
    return mode_.Sticks() ? Stick(contact_, mode_, error_, state_) : Slide(contact_, mode_, error_, state_);
  }

  void Record() {
    if (mode_.Sticks() && !compressions_before_stick_.has_value()) compressions_before_stick_ = compressions_;
    sections_.push_back({.friction = FrictionOf(mode_),
                         .first_loading = mode_.IsFirstLoading(),
                         .indenting = mode_.indenting,
                         .tau = state_.tau,
                         .f = state_.f,
                         .u = state_.u,
                         .v = state_.v});
  }

  // Returns false if the impact ends here.
  bool BeginNextSection(const SectionEnd& end) {
    const int side_before = mode_.slip_side;
    mode_.left_cone_side = 0;
    mode_.begins_with_v_zero = end.turns;
    if (end.passes_largest) mode_.branch = LoadingBranch::kFirstLoading;
    if (end.turns && !ReverseNormalVelocity()) return false;
    if (end.breaks_away != 0) BreakAway(end.breaks_away);
    if (end.stops) StopSlip(side_before, end.passes_largest);
    return true;
  }

  // If eta = 0, the first such reversal is the end.
  bool ReverseNormalVelocity() {
    state_.v = 0.0;
    if (contact_.u_follows_v) state_.u = 0.0;
    const bool may_tie = compressions_ > 0 && mode_.indenting &&
                         std::fabs(state_.normal_force - mode_.largest_normal_force) <= 4.0 * error_.OfNormalForce();
    mode_.indenting = !mode_.indenting;
    has_tie_ = has_tie_ || may_tie;
    if (!mode_.IsFirstLoading()) return true;
    mode_.largest_normal_force = state_.normal_force;
    mode_.branch = LoadingBranch::kUnloading;
    ++compressions_;
    compression_end_ = state_;
    // The true v vanishes at another time, which adds its error times the ratio of the rates to the error of u.
    const double u_rate = contact_.wtn * state_.normal_force - contact_.wtt * state_.spring_force;
    const double v_rate = contact_.wnn * state_.normal_force - contact_.wtn * state_.spring_force;
    compression_force_error_ = error_.OfNormalForce();
    compression_u_error_ = error_.OfU() + std::fabs(u_rate / v_rate) * error_.OfV();
    return contact_.eta > 0.0;
  }

  void BreakAway(int side) {
    // Slip that only rounding has started stops at once.
    const bool stops_at_once =
        contact_.SlipSpeed(mode_.branch, side, state_) <= 0.0 && contact_.SlipSlope(mode_.branch, side) < 0.0;
    mode_.slip_side = stops_at_once ? 0 : side;
    if (stops_at_once) mode_.left_cone_side = side;
  }

  void StopSlip(int side, bool passes_largest) {
    if (contact_.mu == 0.0) {
      mode_.slip_side = -side;
      return;
    }
    // On the softer branch of first loading the particle's speed is positive again.
    const bool sticks = contact_.SlipSlope(mode_.branch, side) < 0.0 && !passes_largest;
    if (!sticks) return;
    mode_.slip_side = 0;
    mode_.left_cone_side = side;
  }

  const SpringContact& contact_;
  PathError error_;
  std::vector<Section>& sections_;
  ContactState state_;
  ContactState compression_end_;
  double compression_force_error_ = 0.0, compression_u_error_ = 0.0;
  SectionMode mode_;
  int compressions_ = 0;  // How often v has changed its sign on first loading.
  // True if two largest forces agree up to rounding, so that either may be the end of compression.
  bool has_tie_ = false;
  std::optional<int> compressions_before_stick_;
};

}  // namespace

PathResult FollowPath(const SpringContact& contact, double u0, double v0, std::vector<Section>& sections) {
  return PathFollower(contact, u0, v0, sections).Follow();
}

}  // namespace ricochet::compliant
