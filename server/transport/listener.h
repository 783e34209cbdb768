// Listener: a socket that waits for connections, on TCP or as a Unix socket.

#ifndef RICOCHET_SERVER_TRANSPORT_LISTENER_H_
#define RICOCHET_SERVER_TRANSPORT_LISTENER_H_

#include <sys/stat.h>
#include <sys/types.h>

#include <vector>

#include "absl/status/statusor.h"
#include "server/base/descriptor.h"
#include "server/base/listen_address.h"

namespace ricochet::server {

class Listener {
 public:
  // Opens a socket for every address that the name of a host has, all on one port. A second server on the same port is
  // refused. The file of a Unix socket gets `socket_mode` (such as 0600); a socket file that no process listens on any
  // more is replaced, and a file of another kind never is.
  // Errors: UNAVAILABLE that names the address and the reason.
  static absl::StatusOr<std::vector<Listener>> Open(const ListenAddress& address, mode_t socket_mode);

  Listener(Listener&&) noexcept = default;
  // Closes the socket, and removes the file of a Unix socket unless another file has taken its place.
  ~Listener();

  int socket() const { return socket_.number(); }
  // The address of the socket in numbers, with the port that the system chose.
  const ListenAddress& address() const { return address_; }

  // Takes the next connection, which does not block. Returns no descriptor if there is none or at an error; errno then
  // tells which.
  Descriptor Accept() const;

 private:
  Listener(Descriptor socket, ListenAddress address) : socket_(std::move(socket)), address_(std::move(address)) {}
  static absl::StatusOr<Listener> OpenUnix(const ListenAddress& address, mode_t socket_mode);

  Descriptor socket_;
  ListenAddress address_;
  struct stat file_ = {};  // The file of a Unix socket as it was made.
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_TRANSPORT_LISTENER_H_
