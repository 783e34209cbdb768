// Peer keys: the names by which limits and fair shares tell one client from another.
//
// An IPv6 host counts by its network of 64 bits, because one host can use every address in it. All clients behind one
// proxy share the proxy's address, unless tokens or certificates tell them apart.

#ifndef RICOCHET_SERVER_PEER_H_
#define RICOCHET_SERVER_PEER_H_

#include <grpcpp/server_context.h>
#include <sys/socket.h>

#include <string>

namespace ricochet::server {

// The property of a call's authentication context that holds the name of the caller whom the authorisation found. Its
// value has the form "token:NAME" or "certificate:NAME".
inline constexpr char kCallerProperty[] = "ricochet_caller";

// Returns who makes a call: "token:NAME", "certificate:NAME", or the peer's address as by AddressKey.
std::string PeerKey(const grpc::ServerContext& context);

// Returns the key of a peer by its text in gRPC, such as "ipv4:192.0.2.1:40000" or "ipv6:%5B2001:db8::1%5D:40000". A text
// of another form is its own key.
std::string AddressKey(const std::string& grpc_peer);

// Returns the key of the peer of a connected socket: "192.0.2.1", "2001:db8::/64", or "unix:UID" with the number of
// the user who connected. A socket without a peer gives "unknown".
std::string AddressKeyOfSocket(int socket);

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_PEER_H_
