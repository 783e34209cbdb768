#include "server/server.h"

#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/resource_quota.h>
#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server_builder.h>

#include <chrono>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/port_file.h"

namespace ricochet::server {
namespace {

constexpr int kMaxReceiveBytes = 1 << 20;
constexpr int kMaxMetadataBytes = 8 << 10;
constexpr int kMaxStreamsPerConnection = 128;

constexpr int Milliseconds(std::chrono::milliseconds time) { return static_cast<int>(time.count()); }

void SetLimits(const Options& options, grpc::ServerBuilder& builder) {
  using std::chrono::minutes;
  using std::chrono::seconds;
  grpc::ResourceQuota quota("ricochetd");
  quota.SetMaxThreads(options.max_threads);
  builder.SetResourceQuota(quota);
  builder.SetMaxReceiveMessageSize(kMaxReceiveBytes);
  builder.AddChannelArgument(GRPC_ARG_MAX_METADATA_SIZE, kMaxMetadataBytes);
  builder.AddChannelArgument(GRPC_ARG_MAX_CONCURRENT_STREAMS, kMaxStreamsPerConnection);
  builder.AddChannelArgument(GRPC_ARG_SERVER_HANDSHAKE_TIMEOUT_MS, Milliseconds(seconds(10)));
  // Keepalive notices a peer that vanished while a sweep waits to be read; clients may send a ping every 20 s.
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, Milliseconds(seconds(30)));
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, Milliseconds(seconds(10)));
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_PERMIT_WITHOUT_CALLS, 1);
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS, Milliseconds(seconds(20)));
  // Old connections are replaced, which spreads clients over new servers; calls on them run to their end.
  builder.AddChannelArgument(GRPC_ARG_MAX_CONNECTION_AGE_MS, Milliseconds(minutes(30)));
  // Otherwise a second server on the same port would silently take part of the connections.
  builder.AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);
}

absl::Status CannotListen(const ListenAddress& address) {
  return absl::UnavailableError(absl::StrCat("cannot listen on ", ToString(address), ": ",
                                             WhyNotBindable(address).value_or("another process used it a moment ago")));
}

}  // namespace

Server::Server(const Options& options, const Log& log)
    : options_(options),
      log_(log),
      address_(options.listen),
      admission_(options.max_live_calls),
      drain_(options.drain_grace, options.drain_timeout),
      observer_(log),
      service_(solver_, options.max_points_per_sweep, drain_.stops(), admission_, observer_) {}

absl::StatusOr<std::unique_ptr<Server>> Server::Start(const Options& options, const Log& log) {
  std::unique_ptr<Server> server(new Server(options, log));
  absl::Status status = server->Listen();
  if (!status.ok()) return status;
  log.Write(LogLevel::kInfo, "listening", {{"address", ToString(server->address())}});
  if (!options.port_file.empty()) status = WritePortFile(options.port_file, server->address().port);
  if (!status.ok()) return status;
  return server;
}

absl::Status Server::Listen() {
  grpc::EnableDefaultHealthCheckService(true);
  grpc::reflection::InitProtoReflectionServerBuilderPlugin();
  grpc::ServerBuilder builder;
  SetLimits(options_, builder);
  builder.AddListeningPort(ToString(address_), grpc::InsecureServerCredentials(), &address_.port);
  builder.RegisterService(&service_);
  server_ = builder.BuildAndStart();
  if (server_ == nullptr) return CannotListen(options_.listen);
  server_->GetHealthCheckService()->SetServingStatus(v1::ImpactService::service_full_name(), true);
  return absl::OkStatus();
}

void Server::ServeUntil(const Signals& signals) {
  const std::string signal = signals.WaitForStop([this] { HangUp(); });
  log_.Write(LogLevel::kInfo, "draining", {{"signal", signal}, {"live_calls", admission_.live()}});
  server_->GetHealthCheckService()->SetServingStatus(false);
  drain_.Run(signals, [this] { return admission_.live(); });
  log_.Write(LogLevel::kInfo, "stopped", {{"live_calls", admission_.live()}});
}

void Server::HangUp() {
  log_.Write(LogLevel::kInfo, "reopening files", {{"signal", "SIGHUP"}});
  for (const std::function<void()>& reopen : reopen_) reopen();
}

Server::~Server() {
  if (server_ != nullptr) server_->Shutdown(std::chrono::system_clock::now());
}

}  // namespace ricochet::server
