#include "server/base/listen_address.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/un.h>

#include <charconv>
#include <cstdint>
#include <system_error>

namespace ricochet::server {
namespace {

constexpr char kUnixScheme[] = "unix:";
constexpr size_t kMostPathBytes = sizeof(sockaddr_un::sun_path) - 1;

std::optional<int> ParsePort(const std::string& text) {
  uint16_t port = 0;
  const char* const end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, port);
  if (result.ec != std::errc() || result.ptr != end) return {};
  return port;
}

bool IsIpv6(const std::string& host) {
  in6_addr address;
  return inet_pton(AF_INET6, host.c_str(), &address) == 1;
}

std::optional<ListenAddress> ParseUnixPath(const std::string& path) {
  if (path.empty() || path.size() > kMostPathBytes) return std::nullopt;
  return ListenAddress{.host = "", .path = path};
}

}  // namespace

std::optional<ListenAddress> ParseListenAddress(const std::string& text) {
  if (text.starts_with(kUnixScheme)) return ParseUnixPath(text.substr(sizeof(kUnixScheme) - 1));
  const size_t colon = text.rfind(':');
  if (colon == std::string::npos) return std::nullopt;
  const auto port = ParsePort(text.substr(colon + 1));
  std::string host = text.substr(0, colon);
  if (!port.has_value() || host.empty()) return std::nullopt;
  if (host.front() == '[') {
    if (host.back() != ']') return std::nullopt;
    host = host.substr(1, host.size() - 2);
    if (!IsIpv6(host)) return std::nullopt;
  } else if (host.find_first_of(": \t/") != std::string::npos) {
    return std::nullopt;
  }
  return ListenAddress{.host = host, .port = *port, .path = ""};
}

std::string ToString(const ListenAddress& address) {
  if (address.is_unix()) return kUnixScheme + address.path;
  const std::string host = IsIpv6(address.host) ? "[" + address.host + "]" : address.host;
  return host + ":" + std::to_string(address.port);
}

bool IsLocal(const ListenAddress& address) {
  if (address.is_unix() || address.host == "localhost") return true;
  in_addr ipv4;
  if (inet_pton(AF_INET, address.host.c_str(), &ipv4) == 1) {
    return ntohl(ipv4.s_addr) >> 24 == IN_LOOPBACKNET;
  }
  in6_addr ipv6;
  return inet_pton(AF_INET6, address.host.c_str(), &ipv6) == 1 && IN6_IS_ADDR_LOOPBACK(&ipv6);
}

}  // namespace ricochet::server
