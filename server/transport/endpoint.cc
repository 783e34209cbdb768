#include "server/transport/endpoint.h"

#include <chrono>
#include <utility>

#include "server/security/credentials.h"
#include "server/security/handshakes.h"
#include "server/security/peer.h"
#include "server/transport/listener.h"

namespace ricochet::server {
namespace {

absl::StatusOr<std::vector<Listener>> OpenAll(const Endpoint::Settings& settings) {
  std::vector<Listener> listeners;
  for (const ListenAddress& address : settings.addresses) {
    absl::StatusOr<std::vector<Listener>> opened = Listener::Open(address, settings.socket_mode);
    if (!opened.ok()) return opened.status();
    for (Listener& listener : *opened) listeners.push_back(std::move(listener));
  }
  return listeners;
}

}  // namespace

absl::StatusOr<std::unique_ptr<Endpoint>> Endpoint::Open(const Settings& settings, grpc::ServerBuilder& builder,
                                                         const Log& log) {
  using Type = grpc::ServerBuilder::experimental_type::ExternalConnectionType;
  const auto credentials = MakeCredentials(settings.tls, settings.auth, log);
  if (!credentials.ok()) return credentials.status();
  absl::StatusOr<std::vector<Listener>> listeners = OpenAll(settings);
  if (!listeners.ok()) return listeners.status();
  std::unique_ptr<Endpoint> endpoint(new Endpoint());
  for (const Listener& listener : *listeners) endpoint->addresses_.push_back(listener.address());
  endpoint->hand_over_ = builder.experimental().AddExternalConnectionAcceptor(Type::FROM_FD, *credentials);
  endpoint->server_ = builder.BuildAndStart();
  if (endpoint->server_ == nullptr) return absl::UnavailableError("gRPC cannot start a server");
  endpoint->acceptor_ = std::make_unique<Acceptor>(*std::move(listeners), settings.connections, log);
  const absl::Status started = endpoint->acceptor_->Start([to = endpoint->hand_over_.get()](int descriptor) {
    grpc::experimental::ExternalConnectionAcceptor::NewConnectionParameters connection;
    connection.fd = descriptor;
    const HandshakesOf peer(AddressOfSocket(descriptor));
    to->HandleNewConnection(&connection);
  });
  if (!started.ok()) return started;
  return endpoint;
}

Endpoint::~Endpoint() {
  // gRPC does not close a connection that is handed over after its shutdown.
  if (acceptor_ != nullptr) acceptor_->StopAccepting();
  if (server_ != nullptr) server_->Shutdown(std::chrono::system_clock::now());
}

}  // namespace ricochet::server
