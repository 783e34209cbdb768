#include "server/admission/service_times.h"

#include <algorithm>

namespace ricochet::server {
namespace {

// The weight of the latest call in the moving average.
constexpr double kWeight = 0.125;

}  // namespace

double ServiceTimes::Expected(const RequestCost& cost) const {
  const std::lock_guard lock(mutex_);
  const auto found = expected_s_.find(cost);
  return found == expected_s_.end() ? 0.0 : found->second;
}

void ServiceTimes::Learn(const RequestCost& cost, double seconds, bool cut_short) {
  const std::lock_guard lock(mutex_);
  const auto [found, is_first] = expected_s_.try_emplace(cost, seconds);
  double& expected = found->second;
  if (cut_short) {
    expected = std::max(expected, 2.0 * seconds);
  } else if (!is_first) {
    expected += kWeight * (seconds - expected);
  }
}

}  // namespace ricochet::server
