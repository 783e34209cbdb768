// ServiceTimes: how long calls take, learned from those that have ended.

#ifndef RICOCHET_SERVER_ADMISSION_SERVICE_TIMES_H_
#define RICOCHET_SERVER_ADMISSION_SERVICE_TIMES_H_

#include <algorithm>
#include <map>
#include <mutex>

#include "server/admission/request_cost.h"

namespace ricochet::server {

// Thread safety: every method may be called from several threads at once.
class ServiceTimes {
 public:
  // Returns the seconds that a call of this cost is expected to compute; 0 if none has ended yet.
  double Expected(const RequestCost& cost) const {
    const std::lock_guard lock(mutex_);
    const auto found = expected_s_.find(cost);
    return found == expected_s_.end() ? 0.0 : found->second;
  }

  // Learns from a call that has computed for `seconds`. A call that was cut short would have taken longer, so that the
  // next one is expected to take twice that time at least.
  void Learn(const RequestCost& cost, double seconds, bool cut_short) {
    const std::lock_guard lock(mutex_);
    const auto [found, is_first] = expected_s_.try_emplace(cost, seconds);
    double& expected = found->second;
    if (cut_short) {
      expected = std::max(expected, 2.0 * seconds);
    } else if (!is_first) {
      expected += kWeight * (seconds - expected);
    }
  }

 private:
  // The weight of the latest call in the moving average.
  static constexpr double kWeight = 0.125;

  mutable std::mutex mutex_;
  std::map<RequestCost, double> expected_s_;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_ADMISSION_SERVICE_TIMES_H_
