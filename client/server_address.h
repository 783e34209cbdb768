// ServerAddress: the form of one server's address, so that what no retry can reach is refused before the first call.

#ifndef RICOCHET_CLIENT_SERVER_ADDRESS_H_
#define RICOCHET_CLIENT_SERVER_ADDRESS_H_

#include <string>

#include "absl/strings/string_view.h"

namespace ricochet {

// Returns the rule that one server of a target breaks, as "must have a port, as host:50051"; empty if it breaks none.
// Right are HOST:PORT, with the schemes dns:, ipv4: and ipv6: of gRPC or none, unix:PATH and unix-abstract:NAME. HOST
// is a name, an IPv4 address or an IPv6 address in brackets, PORT a number from 1 to 65535: gRPC itself would take a
// larger one modulo 65536. Whether a name has an address is not asked.
std::string WhyNoAddress(const std::string& server);

// True for a Unix socket.
bool IsUnixAddress(absl::string_view server);

// True for a loopback address of this host: 127.x.x.x, [::1] or localhost.
bool IsLoopbackAddress(absl::string_view server);

}  // namespace ricochet

#endif  // RICOCHET_CLIENT_SERVER_ADDRESS_H_
