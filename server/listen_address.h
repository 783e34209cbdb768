// ListenAddress: the address HOST:PORT at which a server takes connections.

#ifndef RICOCHET_SERVER_LISTEN_ADDRESS_H_
#define RICOCHET_SERVER_LISTEN_ADDRESS_H_

#include <optional>
#include <string>

namespace ricochet::server {

struct ListenAddress {
  std::string host;  // A name, an IPv4 address, or an IPv6 address without brackets.
  int port = 0;      // 0 to 65535; 0 lets the system choose.

  friend bool operator==(const ListenAddress&, const ListenAddress&) = default;
};

// Reads "HOST:PORT", where an IPv6 host stands in brackets. Returns nothing for any other text.
std::optional<ListenAddress> ParseListenAddress(const std::string& text);

std::string ToString(const ListenAddress& address);

// Returns true if only this host can connect: localhost, 127.0.0.0/8, ::1.
bool IsLoopback(const ListenAddress& address);

// Returns the reason why the system does not let a socket listen there, or nothing if it does.
std::optional<std::string> WhyNotBindable(const ListenAddress& address);

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_LISTEN_ADDRESS_H_
