// Server: the impact service with health checks and limits; server/base/drain.h says how it stops.

#ifndef RICOCHET_SERVER_SERVER_H_
#define RICOCHET_SERVER_SERVER_H_

#include <atomic>
#include <memory>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "ricochet/solver.h"
#include "server/admission/call_memory.h"
#include "server/admission/live_calls.h"
#include "server/admission/scheduler.h"
#include "server/admission/unread_watch.h"
#include "server/admission/watchdog.h"
#include "server/base/drain.h"
#include "server/base/log.h"
#include "server/base/signals.h"
#include "server/calls/bounded_service.h"
#include "server/calls/impact_service.h"
#include "server/health/reflection.h"
#include "server/options.h"
#include "server/security/auth.h"
#include "server/telemetry/metrics_page.h"
#include "server/telemetry/observer.h"
#include "server/transport/endpoint.h"

namespace ricochet::server {

class Server {
 public:
  // Starts a server that takes calls. `log` must outlive it.
  // Errors: INTERNAL if it does not compute right (server/health/self_test.h), UNAVAILABLE if it cannot listen, those
  // of WritePortFile.
  static absl::StatusOr<std::unique_ptr<Server>> Start(const Options& options, const Log& log);

  // Cancels the calls that still run.
  ~Server() = default;
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  // Returns the port of the first TCP address, or 0 if it listens on Unix sockets only.
  int port() const;

  // Serves until a signal stops it, then drains. At each SIGHUP it reopens the log. Call it once; afterwards the
  // process must exit without destroying the server: a client that has stopped reading can block a write for ever, so
  // that a thread may still use this object and its destruction may never end. The exit closes all connections.
  void ServeUntil(const Signals& signals);

 private:
  Server(const Options& options, std::shared_ptr<Auth> auth, const Log& log);
  absl::Status Listen();
  // Adds the metrics of what this server holds now, and serves all metrics if the options ask for it.
  absl::Status OpenMetrics();
  void Watch();
  void SetServing(bool serving);
  void LogAddresses(const std::string& event, const Endpoint& endpoint) const;

  const Options options_;
  const Log& log_;
  const std::shared_ptr<Auth> auth_;  // Null unless there are tokens.
  LocalSolver solver_;                // It has no threads of its own, so that the scheduler alone decides who computes.
  LiveCalls live_calls_;
  CallMemory memory_;
  Drain drain_;
  Scheduler scheduler_;
  UnreadWatch unread_;
  const Observer observer_;
  std::atomic<bool> serving_ = false;  // The health of the service.
  ImpactService service_;
  BoundedService bounded_;
  std::unique_ptr<Endpoint> endpoint_;
  std::unique_ptr<Reflection> reflection_;     // Absent unless the options ask for it.
  std::unique_ptr<MetricsPage> metrics_page_;  // Absent unless the options ask for it.
  std::jthread watchdog_;                      // Runs from the start to the drain.
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_SERVER_H_
