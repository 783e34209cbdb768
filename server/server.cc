#include "server/server.h"

#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/server_builder.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "core/base/try.h"
#include "server/base/port_file.h"
#include "server/health/self_test.h"
#include "server/health/serving_check.h"
#include "server/telemetry/call_interceptor.h"
#include "server/transport/transport.h"

namespace ricochet::server {
namespace {

constexpr std::chrono::milliseconds kTimeForLog(100);
constexpr int64_t kLeastMessageBytes = int64_t{1} << 20;
constexpr std::chrono::seconds kWatchdogPause(5);
constexpr std::chrono::seconds kWatchdogPatience(10);

// Raises the soft limit of open descriptors to the hard limit, which shells and service managers often leave at 1024.
// Returns the limit that then holds.
int64_t RaiseDescriptorLimit() {
  rlimit limit = {};
  getrlimit(RLIMIT_NOFILE, &limit);
  const rlimit raised = {.rlim_cur = limit.rlim_max, .rlim_max = limit.rlim_max};
  if (setrlimit(RLIMIT_NOFILE, &raised) == 0) limit = raised;
  return static_cast<int64_t>(std::min<rlim_t>(limit.rlim_cur, std::numeric_limits<int64_t>::max()));
}

// Returns how many connections fit below `descriptors`, at least 1: each takes two, and 32 stay free for the rest of
// the process.
int64_t ConnectionsBelow(int64_t descriptors) { return std::max<int64_t>((descriptors - 32) / 2, 1); }

// Announces how many connections fit below the limit of descriptors, if that is less than the options allow.
ConnectionLimits LimitsOfConnections(const Options& options, const Log& log) {
  ConnectionLimits limits = options.connections;
  const int64_t descriptors = RaiseDescriptorLimit();
  const int64_t most = ConnectionsBelow(descriptors);
  if (most < limits.in_all) {
    log.Write(LogLevel::kWarning, "fewer connections than asked for",
              {{"descriptors", descriptors}, {"max_connections", most}});
    limits.in_all = static_cast<int>(most);
  }
  return limits;
}

// Returns the callers that the server knows; null if it has no list of them.
absl::StatusOr<std::shared_ptr<Auth>> OpenAuth(const Options& options, const Log& log) {
  if (options.tokens.empty()) return nullptr;
  return Auth::Open(options.tokens, log);
}

}  // namespace

Server::Server(const Options& options, std::shared_ptr<Auth> auth, const Log& log)
    : options_(options),
      log_(log),
      auth_(std::move(auth)),
      solver_(options.limits, 1),
      live_calls_(options.live_calls),
      memory_(options.call_memory_mib << 20),
      drain_(options.drain_grace, options.drain_timeout),
      scheduler_(options.compute_threads, options.max_waiting_calls, drain_.stops().streams),
      unread_(options.unread_limit),
      observer_(log, options.log_calls),
      service_(solver_,
               {.live_calls = live_calls_,
                .memory = memory_,
                .scheduler = scheduler_,
                .unread = unread_,
                .drain = drain_.stops(),
                .limits = options.time_limits,
                .observer = observer_,
                .auth = auth_.get()},
               ServerLimitsOf(options)),
      bounded_(service_,
               [this](grpc::ServerContext& context, BoundedBatches& batches) {
                 return service_.AnswerBatches(context, batches);
               },
               options.limits, {.unread = unread_, .memory = memory_, .auth = auth_.get()}) {
  if (auth_ == nullptr) return;
  auth_->OnRefusal([this](const std::string& reason) { observer_.metrics().Refused(reason); });
}

absl::StatusOr<std::unique_ptr<Server>> Server::Start(const Options& options, const Log& log) {
  Options fitting = options;
  fitting.connections = LimitsOfConnections(options, log);
  RICOCHET_TRY(std::shared_ptr<Auth> auth, OpenAuth(options, log));
  std::unique_ptr<Server> server(new Server(fitting, std::move(auth), log));
  absl::Status status = TestSolver(server->solver_);
  if (status.ok()) status = server->Listen();
  if (status.ok()) status = server->OpenMetrics();
  if (!status.ok()) return status;
  // A script that finds the port file finds the addresses in the log, too.
  log.Flush(kTimeForLog);
  if (!options.port_file.empty()) status = WritePortFile(options.port_file, server->port());
  if (!status.ok()) return status;
  return server;
}

absl::Status Server::Listen() {
  grpc::EnableDefaultHealthCheckService(true);
  grpc::ServerBuilder builder;
  LeaveReflectionOut(builder);
  // Up to twice the limit the answer is an error that names the limit; beyond, gRPC refuses the message.
  const int64_t message_bytes = 2 * std::max(options_.limits.max_request_bytes, kLeastMessageBytes);
  SetTransport({.max_threads = options_.max_threads,
                .memory_bytes = options_.transport_memory_mib << 20,
                .message_bytes = message_bytes,
                .times = options_.transport_times},
               builder);
  WatchCalls(observer_, builder);
  builder.RegisterService(&bounded_);
  Endpoint::Settings settings = {.addresses = options_.listen,
                                 .socket_mode = options_.socket_mode,
                                 .connections = options_.connections,
                                 .tls = options_.tls,
                                 .auth = auth_};
  RICOCHET_TRY(endpoint_, Endpoint::Open(settings, builder, log_));
  SetServing(true);
  Watch();
  LogAddresses("listening", *endpoint_);
  if (options_.reflection.empty()) return absl::OkStatus();
  settings.addresses = options_.reflection;
  RICOCHET_TRY(reflection_, Reflection::Open(settings, log_));
  LogAddresses("reflection", reflection_->endpoint());
  return absl::OkStatus();
}

void Server::SetServing(bool serving) {
  serving_ = serving;
  endpoint_->server().GetHealthCheckService()->SetServingStatus(v1::ImpactService::service_full_name(), serving);
}

void Server::Watch() {
  const auto check = [this](const std::stop_token& stop) {
    return CheckServing(endpoint_->addresses(), endpoint_->acceptor(), scheduler_, kWatchdogPatience, stop);
  };
  const auto report = [this](const absl::Status& status) {
    SetServing(status.ok());
    if (status.ok()) return log_.Write(LogLevel::kInfo, "serving again", {});
    log_.Write(LogLevel::kError, "cannot serve", {{"reason", std::string(status.message())}});
  };
  watchdog_ = StartWatchdog(kWatchdogPause, check, report);
}

absl::Status Server::OpenMetrics() {
  Metrics& metrics = observer_.metrics();
  Acceptor& acceptor = endpoint_->acceptor();
  metrics.AddGauge("ricochet_live_calls", "Calls that hold a place.", [this] { return live_calls_.live(); });
  metrics.AddGauge("ricochet_call_memory_bytes", "Bytes that requests and answers hold.",
                   [this] { return static_cast<double>(memory_.held()); });
  metrics.AddGauge("ricochet_queued_calls", "Calls that wait to compute.",
                   [this] { return static_cast<double>(scheduler_.waiting()); });
  metrics.AddGauge("ricochet_computing_calls", "Calls that compute.",
                   [this] { return static_cast<double>(scheduler_.computing()); });
  metrics.AddGauge("ricochet_serving", "1 while health is SERVING, else 0.", [this] { return serving_ ? 1 : 0; });
  metrics.AddGauge("ricochet_connections", "Connections that are open.",
                   [&acceptor] { return acceptor.counts().open; });
  metrics.AddCounter("ricochet_connections_accepted_total", "Connections accepted since the start.",
                     [&acceptor] { return static_cast<double>(acceptor.counts().accepted); });
  metrics.AddCounter("ricochet_connections_refused_total", "Connections refused since the start.",
                     [&acceptor] { return static_cast<double>(acceptor.counts().refused); });
  metrics.AddCounter("ricochet_log_lines_dropped_total", "Lines that the log could not take.",
                     [this] { return static_cast<double>(log_.dropped()); });
  if (!options_.metrics.has_value()) return absl::OkStatus();
  RICOCHET_TRY(metrics_page_, MetricsPage::Open(*options_.metrics, metrics, [this] { return serving_.load(); }));
  log_.Write(LogLevel::kInfo, "metrics", {{"address", ToString(metrics_page_->address())}});
  return absl::OkStatus();
}

void Server::LogAddresses(const std::string& event, const Endpoint& endpoint) const {
  for (const ListenAddress& address : endpoint.addresses()) {
    log_.Write(LogLevel::kInfo, event, {{"address", ToString(address)}});
    if (IsLocal(address) || !options_.tls.client_ca.empty()) continue;
    const char* const reason = options_.tls.certificate.empty()
                                   ? "--insecure: nothing is encrypted, and every host can stop the service"
                                   : "without --tls-client-ca every host can attack HTTP/2 before it shows a token";
    log_.Write(LogLevel::kWarning, "open to other hosts", {{"address", ToString(address)}, {"reason", reason}});
  }
}

void Server::ServeUntil(const Signals& signals) {
  const std::string signal = signals.WaitForStop([this] {
    log_.Write(LogLevel::kInfo, "reopening files", {{"signal", "SIGHUP"}});
    log_.Reopen().IgnoreError();
  });
  watchdog_ = {};
  serving_ = false;
  endpoint_->server().GetHealthCheckService()->SetServingStatus(false);
  // This line comes last, so that whoever reads it finds health NOT_SERVING.
  log_.Write(LogLevel::kInfo, "draining", {{"signal", signal}, {"live_calls", live_calls_.live()}});
  drain_.Run(signals, [this] { return live_calls_.live(); });
  // Removes the files of Unix sockets.
  endpoint_->acceptor().StopAccepting();
  if (reflection_ != nullptr) reflection_->endpoint().acceptor().StopAccepting();
  if (!options_.port_file.empty()) RemovePortFile(options_.port_file, port());
  log_.Write(LogLevel::kInfo, "stopped", {{"live_calls", live_calls_.live()}});
}

int Server::port() const {
  for (const ListenAddress& address : endpoint_->addresses()) {
    if (!address.is_unix()) return address.port;
  }
  return 0;
}

}  // namespace ricochet::server
