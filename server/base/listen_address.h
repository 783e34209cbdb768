// ListenAddress: the address at which a server takes connections, HOST:PORT or unix:PATH.

#ifndef RICOCHET_SERVER_BASE_LISTEN_ADDRESS_H_
#define RICOCHET_SERVER_BASE_LISTEN_ADDRESS_H_

#include <optional>
#include <string>

namespace ricochet::server {

struct ListenAddress {
  std::string host;  // A name, an IPv4 address, or an IPv6 address without brackets; empty for a Unix socket.
  int port = 0;      // 0 to 65535; 0 lets the system choose. Not used for a Unix socket.
  std::string path;  // The file of a Unix socket, at most 107 bytes; empty for HOST:PORT.

  bool is_unix() const { return !path.empty(); }

  friend bool operator==(const ListenAddress&, const ListenAddress&) = default;
};

// Reads "HOST:PORT", where an IPv6 host stands in brackets, or "unix:PATH". Returns nothing for any other text.
std::optional<ListenAddress> ParseListenAddress(const std::string& text);

std::string ToString(const ListenAddress& address);

// Returns true if only this host can connect: localhost, 127.0.0.0/8, ::1, and every Unix socket.
bool IsLocal(const ListenAddress& address);

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_BASE_LISTEN_ADDRESS_H_
