// MetricsPage: serves the metrics to Prometheus at http://ADDRESS/metrics, on threads and an address of their own.

#ifndef RICOCHET_SERVER_METRICS_PAGE_H_
#define RICOCHET_SERVER_METRICS_PAGE_H_

#include <memory>

#include "absl/status/statusor.h"
#include "server/listen_address.h"
#include "server/metrics.h"

namespace prometheus {
class Exposer;
}

namespace ricochet::server {

class MetricsPage {
 public:
  // Starts to serve. `address` is HOST:PORT with an IP address or localhost; port 0 lets the system choose. `metrics` must
  // outlive the page.
  // Errors: UNAVAILABLE if it cannot listen there.
  static absl::StatusOr<std::unique_ptr<MetricsPage>> Open(const ListenAddress& address, const Metrics& metrics);
  ~MetricsPage();
  MetricsPage(const MetricsPage&) = delete;
  MetricsPage& operator=(const MetricsPage&) = delete;

  // Returns the address with the port that the system chose.
  const ListenAddress& address() const { return address_; }

 private:
  MetricsPage(std::unique_ptr<prometheus::Exposer> exposer, ListenAddress address);

  const std::unique_ptr<prometheus::Exposer> exposer_;
  const ListenAddress address_;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_METRICS_PAGE_H_
