#include "server/security/peer.h"

#include <arpa/inet.h>
#include <grpc/grpc_security_constants.h>
#include <netdb.h>
#include <netinet/in.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"
#include "server/security/auth.h"

namespace ricochet::server {
namespace {

constexpr size_t kNetworkBytes = 8;

std::string Ipv4Key(const in_addr& address) {
  std::array<char, INET_ADDRSTRLEN> text = {};
  inet_ntop(AF_INET, &address, text.data(), text.size());
  return text.data();
}

std::string Ipv6Key(in6_addr address) {
  if (IN6_IS_ADDR_V4MAPPED(&address)) {
    in_addr ipv4 = {};
    std::memcpy(&ipv4, &address.s6_addr[12], sizeof(ipv4));
    return Ipv4Key(ipv4);
  }
  if (IN6_IS_ADDR_LOOPBACK(&address)) return "::1";
  std::fill(std::begin(address.s6_addr) + kNetworkBytes, std::end(address.s6_addr), uint8_t{0});
  std::array<char, INET6_ADDRSTRLEN> text = {};
  inet_ntop(AF_INET6, &address, text.data(), text.size());
  return absl::StrCat(text.data(), "/64");
}

}  // namespace

std::string PeerKey(const grpc::ServerContext& context, Auth* auth) {
  if (auth != nullptr) {
    if (std::string caller = auth->CallerOf(context); !caller.empty()) return caller;
  }
  if (const auto connection = context.auth_context(); connection != nullptr) {
    const std::vector<std::string> names = CertificateNames(*connection);
    if (!names.empty()) return absl::StrCat("certificate:", names.front());
  }
  return AddressKey(context.peer());
}

std::vector<std::string> CertificateNames(const grpc::AuthContext& auth) {
  const std::vector<grpc::string_ref> type = auth.FindPropertyValues(GRPC_TRANSPORT_SECURITY_TYPE_PROPERTY_NAME);
  std::vector<std::string> names;
  // A connection on this host counts as authenticated, too, but has no certificate.
  if (type.empty() || type.front() != GRPC_SSL_TRANSPORT_SECURITY_TYPE || !auth.IsPeerAuthenticated()) return names;
  for (const grpc::string_ref& name : auth.GetPeerIdentity()) names.emplace_back(name.data(), name.size());
  return names;
}

std::string AddressKey(const std::string& grpc_peer) {
  const std::string peer = absl::StrReplaceAll(grpc_peer, {{"%5B", "["}, {"%5D", "]"}, {"%25", "%"}});
  const size_t colon = peer.rfind(':');
  if (absl::StartsWith(peer, "ipv4:") && colon > 5) return peer.substr(5, colon - 5);
  if (absl::StartsWith(peer, "ipv6:[")) {
    in6_addr address;
    const std::string host = peer.substr(6, peer.find_first_of("]%") - 6);
    if (inet_pton(AF_INET6, host.c_str(), &address) == 1) return Ipv6Key(address);
  }
  return peer;
}

std::string AddressKeyOfSocket(int socket) {
  sockaddr_storage address = {};
  socklen_t size = sizeof(address);
  if (getpeername(socket, reinterpret_cast<sockaddr*>(&address), &size) != 0) return "unknown";
  switch (address.ss_family) {
    case AF_INET:
      return Ipv4Key(reinterpret_cast<const sockaddr_in&>(address).sin_addr);
    case AF_INET6:
      return Ipv6Key(reinterpret_cast<const sockaddr_in6&>(address).sin6_addr);
    default:
      break;
  }
  ucred user = {};
  size = sizeof(user);
  if (getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &user, &size) != 0) return "unknown";
  return absl::StrCat("unix:", user.uid);
}

std::string AddressOfSocket(int socket) {
  sockaddr_storage address = {};
  socklen_t size = sizeof(address);
  std::array<char, NI_MAXHOST> host = {};
  std::array<char, NI_MAXSERV> port = {};
  const bool is_known = getpeername(socket, reinterpret_cast<sockaddr*>(&address), &size) == 0 &&
                        (address.ss_family == AF_INET || address.ss_family == AF_INET6) &&
                        getnameinfo(reinterpret_cast<const sockaddr*>(&address), size, host.data(), host.size(),
                                    port.data(), port.size(), NI_NUMERICHOST | NI_NUMERICSERV) == 0;
  if (!is_known) return AddressKeyOfSocket(socket);
  const absl::string_view name = host.data();
  if (address.ss_family == AF_INET) return absl::StrCat("ipv4:", name, ":", port.data());
  constexpr absl::string_view kMapped = "::ffff:";
  if (IN6_IS_ADDR_V4MAPPED(&reinterpret_cast<const sockaddr_in6&>(address).sin6_addr)) {
    return absl::StrCat("ipv4:", absl::StripPrefix(name, kMapped), ":", port.data());
  }
  return absl::StrCat("ipv6:[", name, "]:", port.data());
}

}  // namespace ricochet::server
