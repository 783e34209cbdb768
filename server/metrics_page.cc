#include "server/metrics_page.h"

#include <prometheus/exposer.h>

#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"

namespace ricochet::server {
namespace {

// The options of civetweb: two threads, requests of at most 10 s, no connection kept open.
std::vector<std::string> WebOptions(const ListenAddress& address) {
  ListenAddress numeric = address;
  if (numeric.host == "localhost") numeric.host = "127.0.0.1";
  return {"listening_ports",    ToString(numeric), "num_threads",       "2",
          "request_timeout_ms", "10000",           "enable_keep_alive", "no"};
}

}  // namespace

absl::StatusOr<std::unique_ptr<MetricsPage>> MetricsPage::Open(const ListenAddress& address, const Metrics& metrics) {
  std::unique_ptr<prometheus::Exposer> exposer;
  try {
    exposer = std::make_unique<prometheus::Exposer>(WebOptions(address));
  } catch (const std::exception& error) {
    return absl::UnavailableError(absl::StrCat("cannot serve metrics at ", ToString(address), ": ", error.what()));
  }
  exposer->RegisterCollectable(metrics.counted());
  exposer->RegisterCollectable(metrics.asked());
  ListenAddress bound = address;
  bound.port = exposer->GetListeningPorts().at(0);
  return std::unique_ptr<MetricsPage>(new MetricsPage(std::move(exposer), bound));
}

MetricsPage::MetricsPage(std::unique_ptr<prometheus::Exposer> exposer, ListenAddress address)
    : exposer_(std::move(exposer)), address_(std::move(address)) {}

MetricsPage::~MetricsPage() = default;

}  // namespace ricochet::server
