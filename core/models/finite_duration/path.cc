#include "core/models/finite_duration/path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/models/finite_duration/guards.h"

namespace ricochet::finite_duration {
namespace {

// Budgets of one integration.
constexpr int64_t kWorkBudget = 500'000;  // Evaluations of the rates.
constexpr int64_t kReversalBudget = 200;

class PathFollower {
 public:
  PathFollower(const ScaledContact& contact, Integrator& integrator, double tolerance, StopCheck& stop,
               HistoryRecorder* history)
      : contact_(contact), integrator_(integrator), tolerance_(tolerance), stop_(stop), history_(history) {}

  Path Follow() {
    Begin();
    while (path_.how == PathEnd::kUnderway) FollowMode();
    path_.end = y_;
    if (contact_.compliant) path_.spring_force = ForcesAt(contact_, mode_, y_).tangential;
    if (history_ != nullptr) history_->End(mode_, y_);
    if (mode_.branch == LoadingBranch::kLoading && !compression_ended_) EndCompression();
    path_.local_errors = integrator_.TakeLocalErrors();
    for (size_t i = 0; i < kParts; ++i) path_.local_errors[i] += path_.cut_off[i];
    std::tie(path_.steps, path_.right_hand_sides) = integrator_.TakeCosts();
    return std::move(path_);
  }

 private:
  void Begin() {
    y_ = MotionAtStart(contact_);
    mode_.friction = FrictionAtStart(contact_);
    path_.ever_sticks = mode_.Sticks();
    if (mode_.Sticks()) NoteFirstStop();
    AddEvent(EventKind::kStart);
    if (history_ != nullptr) history_->Begin(mode_, y_);
  }

  void FollowMode() {
    if (NeverReverses(contact_, mode_, y_)) return EndPath(PathEnd::kNeverEnds);
    integrator_.Begin(mode_, y_, tolerance_);
    const Motion before = y_;
    const bool loads = mode_.branch == LoadingBranch::kLoading;
    mode_changed_ = false;
    while (!mode_changed_ && path_.how == PathEnd::kUnderway) {
      if (stop_.IsStopped()) return EndPath(PathEnd::kStopped);
      if (work_ > kWorkBudget) return EndPath(PathEnd::kBudgetUsedUp);
      TakeStep();
    }
    AddStraightPiece(before, loads);
  }

  void AddStraightPiece(const Motion& before, bool loads) {
    const double impulse = y_[kNormal] - before[kNormal];
    Works& works = loads ? path_.straight_loading : path_.straight_other;
    works.normal += 0.5 * (before[kV] + y_[kV]) * impulse;
    works.tangential += 0.5 * (before[kU] + y_[kU]) * (y_[kTangential] - before[kTangential]);
    path_.straight_length = impulse;
    if (impulse > 0.0) path_.straight_slopes = {(y_[kU] - before[kU]) / impulse, (y_[kV] - before[kV]) / impulse};
  }

  void TakeStep() {
    std::array<bool, kModeGuards> fallen;
    work_ -= integrator_.right_hand_sides();
    const bool is_taken = integrator_.Step(fallen);
    work_ += integrator_.right_hand_sides();
    if (!is_taken) return EndPath(PathEnd::kNeverEnds);
    const Motion& next = integrator_.y();
    if (RunsBack(next[kTime]) || LeavesRange(next)) return EndPath(PathEnd::kNeverEnds);
    y_ = next;
    if (history_ != nullptr) history_->AddSamplesOfStep(mode_, y_, stop_);
    path_.peaks.Add(contact_, mode_, y_);
    HandleEvents(fallen);
  }

  // Several guards may fall at once; they are handled in this order. Where u follows v, a particle stops just where v
  // reverses, and whether it then sticks is up to the branch that comes next.
  void HandleEvents(const std::array<bool, kModeGuards>& fallen) {
    const bool reverses_first = ParticleFollowsNormal() && fallen[kReversal];
    if (!reverses_first) ChangeFrictionAsFallen(fallen);
    if (fallen[kBranchEnd]) EndBranch();
    if (fallen[kTension]) Part();
    if (fallen[kReversal] && path_.how == PathEnd::kUnderway) {
      if (reversals_++ == kReversalBudget) return EndPath(PathEnd::kBudgetUsedUp);
      ReverseNormalVelocity();
    }
    if (reverses_first && path_.how == PathEnd::kUnderway) ChangeFrictionAsFallen(fallen);
    path_.peaks.Add(contact_, mode_, y_);
  }

  void ChangeFrictionAsFallen(const std::array<bool, kModeGuards>& fallen) {
    if (fallen[kUpper]) ChangeFriction(kUpper);
    if (fallen[kLower]) ChangeFriction(kLower);
  }

  bool ParticleFollowsNormal() const { return contact_.coupled && contact_.compliant; }

  // If v is far below the unit of the tolerance, results may be rounding alone. A time that runs back shows this.
  bool RunsBack(double time) const {
    constexpr double kRounding = 1e-9;
    return time < y_[kTime] * (1.0 - kRounding) || time < 0.0;
  }

  // A contact that slides on and on under forces that press takes up energy without bound.
  static bool LeavesRange(const Motion& y) {
    constexpr double kLargest = 0x1p500;
    return std::any_of(y.begin(), y.end(), [](double part) { return !(std::fabs(part) <= kLargest); });
  }

  void EndPath(PathEnd how) { path_.how = how; }

  // A contact does not pull: a normal impulse that has fallen since the event before is rounding.
  void AddEvent(EventKind kind) {
    if (!path_.events.empty()) y_[kNormal] = std::max(y_[kNormal], path_.events.back().y[kNormal]);
    path_.events.push_back({kind, y_});
  }

  void NoteFirstStop() {
    if (path_.first_stop != FirstStop::kNever) return;
    path_.first_stop = y_[kV] < 0.0 && !compression_ended_ ? FirstStop::kInCompression : FirstStop::kInRestitution;
    // A spring along t makes every stop stick at first. The regime says how a contact that is rigid along t goes on.
    path_.first_stop_sticks = contact_.compliant ? contact_.holds_freely : mode_.Sticks();
  }

  void ChangeFriction(Guard fallen) {
    const bool slipped = !mode_.Sticks();
    const FrictionState next = FrictionAfter(contact_, mode_, y_, fallen);
    if (next == mode_.friction) return;
    if (slipped && !contact_.compliant) CutOff(kU);
    SetFriction(next);
  }

  void SetFriction(FrictionState next) {
    mode_changed_ = true;
    const bool stuck = mode_.Sticks();
    if (contact_.compliant && !stuck) y_[kSpringForce] = ForcesAt(contact_, mode_, y_).tangential;
    mode_.friction = next;
    path_.ever_sticks = path_.ever_sticks || mode_.Sticks();
    if (!stuck) NoteFirstStop();
    AddEvent(stuck                                  ? EventKind::kSlipStarts
             : mode_.Sticks() && contact_.compliant ? EventKind::kStickStarts
                                                    : EventKind::kSlipStops);
  }

  void Part() {
    EndPath(PathEnd::kParted);
    AddEvent(EventKind::kRestitutionEnds);
  }

  void EndBranch() {
    if (mode_.Unloads()) {
      y_[kPlace] = 0.0;
      return Part();
    }
    mode_changed_ = true;
    y_[kPlace] = mode_.largest_place;
    mode_.branch = LoadingBranch::kLoading;
  }

  void EndCompression() {
    compression_ended_ = true;
    mode_.largest_place = y_[kPlace];
    path_.compression = y_;
  }

  // v has fallen to 0: the contact turns round, comes to rest, or has only touched 0 and goes on.
  void ReverseNormalVelocity() {
    if (contact_.coupled && !contact_.compliant) StopSlipWithNormal();
    const double rate = AccelerationAt(contact_, mode_, ForcesAt(contact_, mode_, y_)).v;
    const bool at_rest = mode_.Sticks() && !contact_.compliant && rate == 0.0;
    const bool goes_on = mode_.Unloads() ? rate >= 0.0 : rate <= 0.0;
    if (!at_rest && goes_on) return;
    mode_changed_ = true;
    CutOff(kV);
    if (ParticleFollowsNormal()) y_[kU] = 0.0;
    const bool compressed =
        mode_.branch == LoadingBranch::kLoading && (!contact_.damped || y_[kPlace] >= mode_.largest_place);
    if (compressed) {
      EndCompression();
      AddEvent(EventKind::kCompressionEnds);
    }
    const bool held = at_rest && compressed && contact_.stick_slope == 0.0;
    if (compressed && contact_.eta == 0.0 && !held) return Part();
    mode_.branch = NextBranch();
    // At rest in restitution, or where the spring balances what presses, the contact neither parts nor moves.
    if (at_rest) EndPath(held ? PathEnd::kHeld : PathEnd::kNeverEnds);
  }

  LoadingBranch NextBranch() const {
    if (!mode_.Unloads()) return LoadingBranch::kUnloading;
    return contact_.damped ? LoadingBranch::kLoading : LoadingBranch::kReloading;
  }

  void StopSlipWithNormal() {
    const FrictionState next = FrictionAtRest(contact_, ForcesAt(contact_, mode_, y_).normal);
    if (next == mode_.friction) return;
    CutOff(kV);
    y_[kU] = 0.0;
    SetFriction(next);
  }

  // Sets to 0 a velocity that has fallen to 0. What is left of it at the root counts as an error.
  void CutOff(size_t velocity) {
    const Motion rates = RatesAt(contact_, mode_, y_);
    // The other velocity is that of a moment earlier or later: its error is this one times the ratio of the rates.
    const double other = std::fabs(rates[velocity == kU ? kV : kU]);
    const double ratio = rates[velocity] != 0.0 ? other / std::fabs(rates[velocity]) : 0.0;
    path_.cut_off[velocity] += std::fabs(y_[velocity]) * std::max(1.0, ratio);
    y_[velocity] = 0.0;
    if (velocity == kV) y_[kStretch] = 1.0;
  }

  const ScaledContact& contact_;
  Integrator& integrator_;
  double tolerance_;
  StopCheck& stop_;
  HistoryRecorder* history_;
  Motion y_ = {};
  Mode mode_;
  Path path_;
  bool mode_changed_ = false;
  bool compression_ended_ = false;
  int64_t reversals_ = 0;
  int64_t work_ = 0;  // Evaluations of the rates in steps; those of a history are not counted.
};

}  // namespace

void Peaks::Add(const ScaledContact& contact, const Mode& mode, const Motion& y) {
  const Forces forces = ForcesAt(contact, mode, y);
  normal = std::max(normal, forces.normal);
  tangential = std::max(tangential, std::fabs(forces.tangential));
  place = std::max(place, y[kPlace]);
  slip = std::max(slip, std::fabs(y[kU]));
  if (mode.Unloads()) restitution_speed = std::max(restitution_speed, y[kV]);
  indentation = std::max(indentation, Indentation(contact, mode, y));
}

Path FollowPath(const ScaledContact& contact, Integrator& integrator, double tolerance, StopCheck& stop,
                HistoryRecorder* history) {
  return PathFollower(contact, integrator, tolerance, stop, history).Follow();
}

}  // namespace ricochet::finite_duration
