// HistoryRecorder: the forces at equal steps of time, read from the integrator while a path is followed. Natural units.

#ifndef RICOCHET_CORE_MODELS_FINITE_DURATION_HISTORY_H_
#define RICOCHET_CORE_MODELS_FINITE_DURATION_HISTORY_H_

#include <cstdint>
#include <vector>

#include "core/models/finite_duration/integrator.h"
#include "core/models/finite_duration/motion.h"
#include "core/models/finite_duration/stop_check.h"

namespace ricochet::finite_duration {

class HistoryRecorder {
 public:
  // `duration` is that of a path that has been followed before with the same integrator and tolerance.
  HistoryRecorder(const ScaledContact& contact, Integrator& integrator, int64_t intervals, double duration)
      : contact_(contact), integrator_(integrator), intervals_(intervals), duration_(duration) {}

  void Begin(const Mode& mode, const Motion& y) { samples_.push_back(SampleOf(mode, y, 0.0)); }
  // Adds the samples within the last step, which ends at `y`. Once stopped, it adds no more.
  void AddSamplesOfStep(const Mode& mode, const Motion& y, StopCheck& stop);
  // Sets the samples that are left to the state at the end; these are all if not even the first step could be taken.
  void End(const Mode& mode, const Motion& y);

  const std::vector<ForceSample>& samples() const { return samples_; }

 private:
  ForceSample SampleOf(const Mode& mode, const Motion& y, double time) const;
  Motion MotionAt(const Mode& mode, double time);

  const ScaledContact& contact_;
  Integrator& integrator_;
  int64_t intervals_;
  double duration_;
  std::vector<ForceSample> samples_;
};

}  // namespace ricochet::finite_duration

#endif  // RICOCHET_CORE_MODELS_FINITE_DURATION_HISTORY_H_
