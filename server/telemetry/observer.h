// Observer: is told of every call, counts it in the metrics, and writes it into the log if the rule for calls says so.

#ifndef RICOCHET_SERVER_TELEMETRY_OBSERVER_H_
#define RICOCHET_SERVER_TELEMETRY_OBSERVER_H_

#include <string>

#include "server/base/log.h"
#include "server/telemetry/call_record.h"
#include "server/telemetry/call_rule.h"
#include "server/telemetry/metrics.h"

namespace ricochet::server {

// Thread safety: every method may be called from several threads at once.
class Observer {
 public:
  // `log` must outlive the observer.
  explicit Observer(const Log& log, const CallRule& rule = {}) : log_(log), sampler_(rule) {}

  // Counts the start of a call; `method` is its name without that of the service.
  void Started(const std::string& method) const { metrics_.Started(method); }
  void Ended(const CallRecord& call) const;

  Metrics& metrics() const { return metrics_; }

 private:
  const Log& log_;
  // Both may be used by several threads at once.
  mutable CallSampler sampler_;
  mutable Metrics metrics_;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_TELEMETRY_OBSERVER_H_
