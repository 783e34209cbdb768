// Peer keys: the names by which limits and fair shares tell one client from another.
//
// An IPv6 host counts by its network of 64 bits, because one host can use every address in it. All clients behind one
// proxy share the proxy's address, unless tokens or certificates tell them apart.

#ifndef RICOCHET_SERVER_SECURITY_PEER_H_
#define RICOCHET_SERVER_SECURITY_PEER_H_

#include <grpcpp/server_context.h>
#include <sys/socket.h>

#include <string>
#include <vector>

namespace ricochet::server {

class Auth;

// Returns who makes a call: "token:NAME" or "certificate:NAME" if `auth` knows the caller, "certificate:NAME" of a
// client certificate that was verified, or else the peer's address as by AddressKey. Absent `auth`, tokens count for
// nothing.
std::string PeerKey(const grpc::ServerContext& context, Auth* auth = nullptr);

// Returns the names in a client certificate that was verified: its alternative names, or else its common name.
std::vector<std::string> CertificateNames(const grpc::AuthContext& auth);

// Returns the key of a peer by its text in gRPC, such as "ipv4:192.0.2.1:40000" or "ipv6:%5B2001:db8::1%5D:40000". A
// text of another form is its own key.
std::string AddressKey(const std::string& grpc_peer);

// Returns the key of the peer of a connected socket: "192.0.2.1", "2001:db8::/64", or "unix:UID" with the number of
// the user who connected. A socket without a peer gives "unknown".
std::string AddressKeyOfSocket(int socket);

// Returns the whole address of the peer of a connected socket, as gRPC spells it: "ipv4:192.0.2.1:40000",
// "ipv6:[2001:db8::1]:40000"; for a Unix socket its key.
std::string AddressOfSocket(int socket);

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_SECURITY_PEER_H_
