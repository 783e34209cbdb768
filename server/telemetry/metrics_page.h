// MetricsPage: answers HTTP on threads and an address of its own, for programs that watch a server.
//
//   GET /metrics   200 and the metrics, as Prometheus reads them
//   GET /healthz   200 and "SERVING" while the gRPC health of the server is SERVING, else 503 and "NOT_SERVING"

#ifndef RICOCHET_SERVER_TELEMETRY_METRICS_PAGE_H_
#define RICOCHET_SERVER_TELEMETRY_METRICS_PAGE_H_

#include <functional>
#include <memory>
#include <utility>

#include "absl/status/statusor.h"
#include "server/base/listen_address.h"
#include "server/telemetry/metrics.h"

struct mg_connection;
struct mg_context;

namespace ricochet::server {

class MetricsPage {
 public:
  // Starts to serve. `address` is HOST:PORT with an IP address or localhost; port 0 lets the system choose. `metrics`
  // must outlive the page; `is_serving` is asked by several threads at once. Errors: UNAVAILABLE if it cannot listen
  // there.
  static absl::StatusOr<std::unique_ptr<MetricsPage>> Open(const ListenAddress& address, const Metrics& metrics,
                                                           std::function<bool()> is_serving);
  ~MetricsPage();
  MetricsPage(const MetricsPage&) = delete;
  MetricsPage& operator=(const MetricsPage&) = delete;

  // Returns the address with the port that the system chose.
  const ListenAddress& address() const { return address_; }

 private:
  MetricsPage(ListenAddress address, const Metrics& metrics, std::function<bool()> is_serving)
      : metrics_(metrics), is_serving_(std::move(is_serving)), address_(std::move(address)) {}
  absl::Status Start();
  static int AnswerMetrics(mg_connection* connection, void* page);
  static int AnswerHealth(mg_connection* connection, void* page);

  const Metrics& metrics_;
  const std::function<bool()> is_serving_;
  ListenAddress address_;
  mg_context* web_ = nullptr;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_TELEMETRY_METRICS_PAGE_H_
