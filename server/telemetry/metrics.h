// Metrics: what Prometheus can read of a server: counts of calls, work and refusals, and gauges of what is held now.
//
// The names and buckets of grpc_server_* are those of gRFC A66 in Prometheus's spelling. deploy/README.md lists all.
// https://github.com/grpc/proposal/blob/master/A66-otel-stats.md
//
// The number of time series is bounded: labels are methods of the service, or "other"; status codes; reasons and models
// that this program names. Text of callers is never a label.

#ifndef RICOCHET_SERVER_TELEMETRY_METRICS_H_
#define RICOCHET_SERVER_TELEMETRY_METRICS_H_

#include <functional>
#include <memory>
#include <string>

#include "server/telemetry/call_record.h"

namespace ricochet::server {

// Thread safety: every method may be called from several threads at once.
class Metrics {
 public:
  Metrics();
  ~Metrics();
  Metrics(const Metrics&) = delete;
  Metrics& operator=(const Metrics&) = delete;

  // Counts the start of a call; `method` is its name without that of the service.
  void Started(const std::string& method);

  // Counts everything else of a call that has ended; also the points of a sweep, which do not show while it runs.
  void Ended(const CallRecord& call);

  // Counts a call that was refused for one of Reasons(), and of which no record is kept.
  void Refused(const std::string& reason);

  // These two add a metric whose value is asked for at each scrape, on the thread of the scrape. `value` must be valid
  // as long as this object. A counter never falls.
  void AddGauge(const std::string& name, const std::string& help, std::function<double()> value);
  void AddCounter(const std::string& name, const std::string& help, std::function<double()> value);

  // Returns all metrics as Prometheus reads them.
  std::string Text() const;

 private:
  struct State;
  const std::unique_ptr<State> state_;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_TELEMETRY_METRICS_H_
