#include "client/server_address.h"

#include <arpa/inet.h>

#include <algorithm>
#include <array>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"

namespace ricochet {
namespace {

constexpr int kMostPort = 65535;

// Removes the scheme of a network address. In dns://SERVER/NAME, SERVER is the name server and is removed, too.
absl::string_view WithoutScheme(absl::string_view server) {
  if (absl::ConsumePrefix(&server, "dns://")) {
    const size_t slash = server.find('/');
    return slash == absl::string_view::npos ? absl::string_view() : server.substr(slash + 1);
  }
  for (const char* scheme : {"dns:", "ipv4:", "ipv6:"}) {
    if (absl::ConsumePrefix(&server, scheme)) break;
  }
  return server;
}

// True if the text is an address of the family AF_INET or AF_INET6.
bool IsAddress(int family, absl::string_view text) {
  std::array<unsigned char, sizeof(in6_addr)> address = {};
  return inet_pton(family, std::string(text).c_str(), address.data()) == 1;
}

// Returns the host of HOST:PORT or HOST, with its brackets.
absl::string_view HostOf(absl::string_view address) {
  const size_t colon = address.rfind(':');
  const size_t bracket = address.rfind(']');
  const bool has_port = colon != absl::string_view::npos && (bracket == absl::string_view::npos || colon > bracket);
  return has_port ? address.substr(0, colon) : address;
}

std::string WhyNoHost(absl::string_view host) {
  if (host.empty()) return "must have a host before its port";
  const bool is_bracketed = absl::ConsumePrefix(&host, "[") && absl::ConsumeSuffix(&host, "]");
  if (is_bracketed) {
    // A zone, as in fe80::1%eth0, is for the system to know.
    const bool is_ipv6 = IsAddress(AF_INET6, host.substr(0, host.find('%')));
    return is_ipv6 ? "" : "must have an IPv6 address between its brackets";
  }
  if (absl::StrContains(host, ':')) return "must have brackets around an IPv6 address, as [::1]:50051";
  const auto is_of_name = [](unsigned char c) { return absl::ascii_isalnum(c) || c == '.' || c == '-' || c == '_'; };
  if (!std::all_of(host.begin(), host.end(), is_of_name))
    return "must have a host of letters, digits, dots and hyphens";
  const bool is_name = host.find_first_not_of("0123456789.") != absl::string_view::npos;
  return is_name || IsAddress(AF_INET, host) ? "" : "must have an IPv4 address of four numbers up to 255";
}

}  // namespace

std::string WhyNoAddress(const std::string& server) {
  if (IsUnixAddress(server)) {
    const bool has_path = server.find_first_not_of('/', server.find(':') + 1) != std::string::npos;
    return has_path ? "" : "must have a path after unix:";
  }
  const absl::string_view address = WithoutScheme(server);
  if (const size_t scheme = address.find("://"); scheme != absl::string_view::npos) {
    return absl::StrCat("must be HOST:PORT or unix:PATH, without ", address.substr(0, scheme), "://");
  }
  const absl::string_view host = HostOf(address);
  if (host.size() == address.size()) return absl::StrCat("must have a port, as ", address, ":50051");
  if (std::string wrong = WhyNoHost(host); !wrong.empty()) return wrong;
  int port = 0;
  if (absl::SimpleAtoi(address.substr(host.size() + 1), &port) && port >= 1 && port <= kMostPort) return "";
  return absl::StrCat("must have a port from 1 to ", kMostPort);
}

bool IsUnixAddress(absl::string_view server) {
  return absl::StartsWith(server, "unix:") || absl::StartsWith(server, "unix-abstract:");
}

bool IsLoopbackAddress(absl::string_view server) {
  const absl::string_view host = HostOf(WithoutScheme(server));
  return host == "localhost" || host == "[::1]" || (absl::StartsWith(host, "127.") && IsAddress(AF_INET, host));
}

}  // namespace ricochet
