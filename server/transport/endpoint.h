// Endpoint: a gRPC server and the acceptor that brings it connections, at addresses of its own.

#ifndef RICOCHET_SERVER_TRANSPORT_ENDPOINT_H_
#define RICOCHET_SERVER_TRANSPORT_ENDPOINT_H_

#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>
#include <sys/types.h>

#include <memory>
#include <vector>

#include "absl/status/statusor.h"
#include "server/base/listen_address.h"
#include "server/base/log.h"
#include "server/security/auth.h"
#include "server/security/tls_files.h"
#include "server/transport/acceptor.h"
#include "server/transport/connection_counts.h"

namespace ricochet::server {

class Endpoint {
 public:
  struct Settings {
    std::vector<ListenAddress> addresses;
    mode_t socket_mode = 0600;
    ConnectionLimits connections;
    TlsPaths tls;                // Empty paths: no TLS.
    std::shared_ptr<Auth> auth;  // Null: whoever can connect may call everything.
  };

  // Starts the server that `builder` describes, and takes connections. `log` must outlive the endpoint.
  // Errors: UNAVAILABLE if it cannot listen, and those of MakeCredentials.
  static absl::StatusOr<std::unique_ptr<Endpoint>> Open(const Settings& settings, grpc::ServerBuilder& builder,
                                                        const Log& log);

  // Ends every connection and cancels the calls that still run.
  ~Endpoint();
  Endpoint(const Endpoint&) = delete;
  Endpoint& operator=(const Endpoint&) = delete;

  // Returns the addresses with the ports that the system chose, one for each socket.
  const std::vector<ListenAddress>& addresses() const { return addresses_; }
  Acceptor& acceptor() { return *acceptor_; }
  grpc::Server& server() { return *server_; }

 private:
  Endpoint() = default;

  std::vector<ListenAddress> addresses_;
  std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> hand_over_;
  std::unique_ptr<grpc::Server> server_;
  std::unique_ptr<Acceptor> acceptor_;  // The last member: it stops before the server that it feeds is destroyed.
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_TRANSPORT_ENDPOINT_H_
