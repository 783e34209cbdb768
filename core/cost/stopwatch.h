// Stopwatch and TimeOf: the only readers of a clock in the core. They measure how long a piece of work takes.
//
// One solve may take some nanoseconds, which is less than a clock resolves. A sample therefore repeats it until it
// lasts long enough, and its time is divided by the number of repetitions. The first repetitions only find that number,
// and warm caches and branch predictors. The median and the quartiles of the samples are answered: other programs on
// the machine disturb some samples, and these do not move a median.

#ifndef RICOCHET_CORE_COST_STOPWATCH_H_
#define RICOCHET_CORE_COST_STOPWATCH_H_

#include <chrono>
#include <cstdint>
#include <optional>

#include "absl/functional/function_ref.h"
#include "ricochet/cost.h"

namespace ricochet {

// Measures the time since it was made, or since it was started anew.
class Stopwatch {
 public:
  double elapsed_s() const;
  void Restart() { start_ = std::chrono::steady_clock::now(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

struct Sampling {
  int32_t samples = kDefaultCostSamples;
  double budget_s = 0.0;  // No sample is begun once so much time has passed; the first one is always taken.
};

// Times work that comes in units. `work(n)` does n units; a sample takes at least 20 us, and at least one unit.
// `stopped` is asked before each sample. Once it says true there is no result.
std::optional<CostTime> TimeOf(absl::FunctionRef<void(int64_t units)> work, const Sampling& sampling,
                               absl::FunctionRef<bool()> stopped);

// Times a list of `size` units, of which a sample does all. `work(first, count)` does a part of the list: `part` units,
// or those that are left. Quartiles are sums of the quartiles of parts, because a whole list may take longer than the
// machine leaves a program undisturbed. `stopped` is asked before each part; the asking is not timed.
std::optional<CostTime> TimeOfList(absl::FunctionRef<void(int64_t first, int64_t count)> work, int64_t size,
                                   int64_t part, const Sampling& sampling, absl::FunctionRef<bool()> stopped);

}  // namespace ricochet

#endif  // RICOCHET_CORE_COST_STOPWATCH_H_
