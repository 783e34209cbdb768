#include "server/telemetry/metrics_page.h"

#include <civetweb.h>

#include <array>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"

namespace ricochet::server {
namespace {

constexpr char kMetricsType[] = "text/plain; version=0.0.4; charset=utf-8";

// Answers a request and returns the code for the log of civetweb. Only GET and HEAD are taken.
int Answer(mg_connection* connection, absl::string_view status, absl::string_view type, absl::string_view body) {
  const absl::string_view method = mg_get_request_info(connection)->request_method;
  const bool is_head = method == "HEAD";
  if (method != "GET" && !is_head) {
    status = "405 Method Not Allowed";
    body = "must be GET or HEAD\n";
  }
  const std::string text = absl::StrCat(
      "HTTP/1.1 ", status, "\r\nContent-Type: ", type, "\r\nContent-Length: ", body.size(),
      "\r\nCache-Control: no-store\r\nAllow: GET, HEAD\r\n", "Connection: close\r\n\r\n", is_head ? "" : body);
  mg_write(connection, text.data(), text.size());
  return 1;
}

}  // namespace

absl::StatusOr<std::unique_ptr<MetricsPage>> MetricsPage::Open(const ListenAddress& address, const Metrics& metrics,
                                                               std::function<bool()> is_serving) {
  std::unique_ptr<MetricsPage> page(new MetricsPage(address, metrics, std::move(is_serving)));
  if (absl::Status started = page->Start(); !started.ok()) return started;
  return page;
}

absl::Status MetricsPage::Start() {
  mg_init_library(0);
  ListenAddress numeric = address_;
  if (numeric.host == "localhost") numeric.host = "127.0.0.1";
  const std::string where = ToString(numeric);
  // A connection has a thread until it ends: it is not kept open, and may be silent for five seconds. With 32 threads a
  // probe of health is answered beside some clients that send nothing.
  std::array<const char*, 9> options = {
      "listening_ports",   where.c_str(), "num_threads", "32", "request_timeout_ms", "5000",
      "enable_keep_alive", "no",          nullptr};
  std::array<char, 256> reason = {};
  mg_init_data how = {.callbacks = nullptr, .user_data = this, .configuration_options = options.data()};
  mg_error_data error = {.code = nullptr, .text = reason.data(), .text_buffer_size = reason.size()};
  web_ = mg_start2(&how, &error);
  if (web_ == nullptr) {
    return absl::UnavailableError(absl::StrCat("cannot serve metrics at ", ToString(address_), ": ", reason.data()));
  }
  mg_set_request_handler(web_, "/metrics$", &AnswerMetrics, this);
  mg_set_request_handler(web_, "/healthz$", &AnswerHealth, this);
  mg_server_port port = {};
  if (mg_get_server_ports(web_, 1, &port) == 1) address_.port = port.port;
  return absl::OkStatus();
}

MetricsPage::~MetricsPage() {
  if (web_ != nullptr) mg_stop(web_);
  mg_exit_library();
}

int MetricsPage::AnswerMetrics(mg_connection* connection, void* page) {
  return Answer(connection, "200 OK", kMetricsType, static_cast<const MetricsPage*>(page)->metrics_.Text());
}

int MetricsPage::AnswerHealth(mg_connection* connection, void* page) {
  const bool is_serving = static_cast<const MetricsPage*>(page)->is_serving_();
  return Answer(connection, is_serving ? "200 OK" : "503 Service Unavailable", "text/plain",
                is_serving ? "SERVING\n" : "NOT_SERVING\n");
}

}  // namespace ricochet::server
