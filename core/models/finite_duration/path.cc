#include "core/models/finite_duration/path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

namespace ricochet::finite_duration {
namespace {

// Both for one integration.
constexpr int64_t kStepBudget = 50'000;
constexpr int64_t kTurnBudget = 200;

ForceSample SampleOf(const Contact& contact, const Mode& mode, const Motion& y, double time) {
  const Forces forces = ForcesAt(contact, mode, y);
  return {time, forces.tangential, forces.normal, Indentation(contact, mode, y), y[kU], y[kV]};
}

// One integration, mode by mode.
class Follower {
 public:
  Follower(const Contact& contact, Integrator& integrator, double tolerance, History* history)
      : contact_(contact), integrator_(integrator), tolerance_(tolerance), history_(history) {}

  Path Follow() {
    y_ = StartOf(contact_);
    mode_.grip = GripAtStart(contact_);
    path_.ever_sticks = mode_.grip == Grip::kStick;
    if (contact_.u0 == 0.0 && !contact_.compliant && path_.ever_sticks) NoteStop();
    if (contact_.compliant && path_.ever_sticks) NoteStop();
    AddEvent(EventKind::kStart);
    if (history_ != nullptr) history_->samples.push_back(SampleOf(contact_, mode_, y_, 0.0));
    while (!path_.parted && !path_.held && FollowMode()) {
    }
    path_.end = y_;
    if (contact_.compliant) path_.spring_force = ForcesAt(contact_, mode_, y_).tangential;
    if (history_ != nullptr) EndHistory();
    if (mode_.line == Line::kLoading && !compression_ended_) EndCompression();
    path_.local_errors = integrator_.TakeLocalErrors();
    for (size_t i = 0; i < kParts; ++i) path_.local_errors[i] += cut_off_[i];
    std::tie(path_.steps, path_.right_hand_sides) = integrator_.TakeCosts();
    return std::move(path_);
  }

 private:
  // False if a budget runs out.
  bool FollowMode() {
    if (stays_ || NeverTurns(contact_, mode_, y_)) return false;
    integrator_.Begin(mode_, y_, tolerance_);
    changed_ = false;
    while (!changed_) {
      std::array<bool, kModeGuards> fallen;
      if (steps_++ == kStepBudget) return false;
      const Integrator::Progress progress = integrator_.Step(fallen);
      if (progress == Integrator::Progress::kFailed) return false;
      if (progress == Integrator::Progress::kCrowded) return integrator_.s() > 0.0;
      if (RunsBack(integrator_.y()[kTime])) return false;
      y_ = integrator_.y();
      if (history_ != nullptr) TakeSamples();
      NotePeaks();
      // A guard that starts at 0 and falls is no root: it is below 0 at the end of a step.
      const Guards guards = GuardsAt(contact_, mode_, y_);
      for (size_t i = 0; i < kModeGuards; ++i) fallen[i] = fallen[i] || guards[i] < 0.0;
      if (fallen[kUpper]) LeaveGrip(kUpper);
      if (fallen[kLower]) LeaveGrip(kLower);
      if (fallen[kLineEnd]) EndLine();
      if (fallen[kTension]) Part();
      if (fallen[kTurn] && !path_.parted && turns_++ == kTurnBudget) return false;
      if (fallen[kTurn] && !path_.parted) Turn();
      NotePeaks();
    }
    return true;
  }

  // Where v is far below what the tolerance is a part of, all that it leads to may be rounding: time that runs back is.
  bool RunsBack(double time) const {
    constexpr double kRounding = 1e-9;
    return time < y_[kTime] * (1.0 - kRounding) || time < 0.0;
  }

  void AddEvent(EventKind kind) { path_.events.push_back({kind, y_}); }

  void NotePeaks() {
    const Forces forces = ForcesAt(contact_, mode_, y_);
    path_.peak_normal = std::max(path_.peak_normal, forces.normal);
    path_.peak_tangential = std::max(path_.peak_tangential, std::fabs(forces.tangential));
    path_.largest_place = std::max(path_.largest_place, y_[kPlace]);
    if (mode_.line == Line::kUnloading) path_.fastest = std::max(path_.fastest, y_[kV]);
    path_.indentation = std::max(path_.indentation, Indentation(contact_, mode_, y_));
  }

  void NoteStop() {
    if (path_.stop != Stop::kNever) return;
    path_.stop = y_[kV] < 0.0 && !compression_ended_ ? Stop::kInCompression : Stop::kInRestitution;
    path_.first_stop_sticks = mode_.grip == Grip::kStick;
  }

  void Grasp(Grip grip) {
    changed_ = true;
    const bool stuck = mode_.grip == Grip::kStick;
    if (contact_.compliant && !stuck) y_[kSpringForce] = ForcesAt(contact_, mode_, y_).tangential;
    mode_.grip = grip;
    const bool sticks = grip == Grip::kStick;
    path_.ever_sticks = path_.ever_sticks || sticks;
    if (!stuck) NoteStop();
    AddEvent(stuck                          ? EventKind::kSlipStarts
             : sticks && contact_.compliant ? EventKind::kStickStarts
                                            : EventKind::kSlipStops);
  }

  void LeaveGrip(Guard fallen) {
    const bool slid = mode_.grip != Grip::kStick;
    const Grip next = GripAfter(contact_, mode_, y_, fallen);
    if (next == mode_.grip) return;
    if (slid && !contact_.compliant) Zero(kU);
    Grasp(next);
  }

  void Part() {
    changed_ = true;
    path_.parted = true;
    AddEvent(EventKind::kRestitutionEnds);
  }

  void EndLine() {
    if (mode_.line == Line::kUnloading) {
      y_[kPlace] = 0.0;
      Part();
      return;
    }
    changed_ = true;
    y_[kPlace] = mode_.largest;
    mode_.line = Line::kLoading;
    loading_start_ = {y_[kNormalWork], y_[kTangentWork]};
  }

  void EndCompression() {
    compression_ended_ = true;
    mode_.largest = y_[kPlace];
    path_.compression = y_;
    Works& works = path_.compression_works;
    if (contact_.damped) {
      works = {y_[kNormalWork], y_[kTangentWork]};
    } else {
      works.normal += y_[kNormalWork] - loading_start_.normal;
      works.tangential += y_[kTangentWork] - loading_start_.tangential;
    }
  }

  // v = 0.
  void Turn() {
    if (contact_.coupled && !contact_.compliant) StopWithNormal();
    const Forces forces = ForcesAt(contact_, mode_, y_);
    const double rate = AccelerationAt(contact_, mode_, forces).v;
    const bool held = mode_.grip == Grip::kStick && !contact_.compliant && rate == 0.0;
    const bool opens = mode_.line != Line::kUnloading;
    // What has but touched 0 goes on.
    if (!held && (opens ? rate <= 0.0 : rate >= 0.0)) return;
    changed_ = true;
    Zero(kV);
    const bool compressed = mode_.line == Line::kLoading && (!contact_.damped || y_[kPlace] >= mode_.largest);
    // At rest in restitution, or where the spring balances what presses, it neither parts nor moves.
    stays_ = held && (!compressed || contact_.stick_slope != 0.0);
    path_.held = held && !stays_;
    if (compressed) {
      EndCompression();
      AddEvent(EventKind::kCompressionEnds);
      if (contact_.eta == 0.0 && !path_.held) return Part();
    }
    const Line closing = contact_.damped ? Line::kLoading : Line::kReloading;
    mode_.line = opens ? Line::kUnloading : closing;
  }

  void StopWithNormal() {
    const Grip next = GripAtRest(contact_, ForcesAt(contact_, mode_, y_).normal);
    if (next == mode_.grip) return;
    Zero(kV);
    y_[kU] = 0.0;
    Grasp(next);
  }

  // Where a velocity has fallen to 0. A root is known to 1e-14 of s, in which a steep one goes far: Newton's step takes
  // it closer, and what is left of it is an error.
  void Zero(size_t velocity) {
    const double s = integrator_.s() - y_[velocity] / RatesAt(contact_, mode_, y_)[velocity];
    if (s > integrator_.previous_s() && s < integrator_.s()) y_ = integrator_.Between(s);
    cut_off_[velocity] += std::fabs(y_[velocity]);
    y_[velocity] = 0.0;
  }

  // The motion at `time`, which lies in the last step.
  Motion At(double time) {
    double low = integrator_.previous_s();
    double high = integrator_.s();
    double guess = 0.5 * (low + high);
    Motion y = integrator_.Between(guess);
    // Newton's steps, halvings where they leave the bracket; 60 halvings have it to the last bit.
    for (int i = 0; i < 60; ++i) {
      const double miss = y[kTime] - time;
      (miss > 0.0 ? high : low) = guess;
      const double next = guess - miss / RatesAt(contact_, mode_, y)[kTime];
      const double clipped = next > low && next < high ? next : 0.5 * (low + high);
      if (clipped == guess || !(high > low)) break;
      guess = clipped;
      y = integrator_.Between(guess);
    }
    return y;
  }

  void TakeSamples() {
    const auto intervals = static_cast<double>(history_->intervals);
    while (static_cast<int64_t>(history_->samples.size()) < history_->intervals) {
      const double time = history_->duration * (static_cast<double>(history_->samples.size()) / intervals);
      if (time > y_[kTime]) return;
      history_->samples.push_back(SampleOf(contact_, mode_, At(time), time));
    }
  }

  // Where not even the first step can be taken, all its times are that of the end.
  void EndHistory() {
    const ForceSample end = SampleOf(contact_, mode_, y_, y_[kTime]);
    history_->samples.resize(static_cast<size_t>(history_->intervals), end);
    history_->samples.push_back(end);
  }

  const Contact& contact_;
  Integrator& integrator_;
  double tolerance_;
  History* history_;
  Motion y_ = {};
  Mode mode_;
  Path path_;
  Motion cut_off_ = {};  // What has been set to 0.
  bool changed_ = false;
  bool compression_ended_ = false;
  bool stays_ = false;
  Works loading_start_;
  int64_t steps_ = 0;
  int64_t turns_ = 0;
};

}  // namespace

Path Follow(const Contact& contact, Integrator& integrator, double tolerance, History* history) {
  return Follower(contact, integrator, tolerance, history).Follow();
}

}  // namespace ricochet::finite_duration
