#include "core/models/finite_duration/history.h"

#include <algorithm>

namespace ricochet::finite_duration {

void HistoryRecorder::AddSamplesOfStep(const Mode& mode, const Motion& y, StopCheck& stop) {
  const auto intervals = static_cast<double>(intervals_);
  while (static_cast<int64_t>(samples_.size()) < intervals_ && !stop.IsStopped()) {
    const double time = duration_ * (static_cast<double>(samples_.size()) / intervals);
    if (time > y[kTime]) return;
    samples_.push_back(SampleOf(mode, MotionAt(mode, time), time));
  }
}

void HistoryRecorder::End(const Mode& mode, const Motion& y) {
  const ForceSample end = SampleOf(mode, y, y[kTime]);
  samples_.resize(static_cast<size_t>(intervals_), end);
  samples_.push_back(end);
}

ForceSample HistoryRecorder::SampleOf(const Mode& mode, const Motion& y, double time) const {
  const Forces forces = ForcesAt(contact_, mode, y);
  // A contact does not pull: N < 0 is rounding.
  return {time, forces.tangential, std::max(forces.normal, 0.0), Indentation(contact_, mode, y), y[kU], y[kV]};
}

// The motion at `time`, which lies in the last step.
Motion HistoryRecorder::MotionAt(const Mode& mode, double time) {
  double low = integrator_.previous_s();
  double high = integrator_.s();
  double guess = 0.5 * (low + high);
  Motion y = integrator_.Between(guess);
  // Newton's steps are replaced by halvings where they leave the bracket; 60 halvings reach the last bit.
  for (int i = 0; i < 60; ++i) {
    const double miss = y[kTime] - time;
    (miss > 0.0 ? high : low) = guess;
    const double next = guess - miss / RatesAt(contact_, mode, y)[kTime];
    const double clipped = next > low && next < high ? next : 0.5 * (low + high);
    if (clipped == guess || !(high > low)) break;
    guess = clipped;
    y = integrator_.Between(guess);
  }
  return y;
}

}  // namespace ricochet::finite_duration
