#include "server/transport/listener.h"

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <system_error>
#include <utility>

#include "absl/strings/str_cat.h"

namespace ricochet::server {
namespace {

// The system cuts this down to net.core.somaxconn.
constexpr int kBacklog = 4096;

// A connection whose peer acknowledges nothing for this time is broken off.
constexpr unsigned kAcknowledgeWithinMs = 10'000;

absl::Status CannotListen(const ListenAddress& address, const std::string& reason) {
  return absl::UnavailableError(absl::StrCat("cannot listen on ", ToString(address), ": ", reason));
}

std::string ErrorText() { return std::system_category().message(errno); }

bool Set(int socket, int level, int option, unsigned value) {
  return setsockopt(socket, level, option, &value, sizeof(value)) == 0;
}

// Accepted sockets inherit these options.
bool SetTcpOptions(int socket, int family) {
  // A connection that lingers after its close does not keep the port, and [::] takes IPv4 too.
  return Set(socket, SOL_SOCKET, SO_REUSEADDR, 1) && Set(socket, IPPROTO_TCP, TCP_NODELAY, 1) &&
         Set(socket, IPPROTO_TCP, TCP_USER_TIMEOUT, kAcknowledgeWithinMs) &&
         (family != AF_INET6 || Set(socket, IPPROTO_IPV6, IPV6_V6ONLY, 0));
}

// Returns the socket, or nothing and the reason in errno.
Descriptor BindTcp(const addrinfo& address) {
  Descriptor socket(::socket(address.ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (socket.is_open() && SetTcpOptions(socket.number(), address.ai_family) &&
      bind(socket.number(), address.ai_addr, address.ai_addrlen) == 0 && listen(socket.number(), kBacklog) == 0) {
    return socket;
  }
  const int error = errno;
  socket = Descriptor();
  errno = error;
  return socket;
}

int PortOf(int socket) {
  sockaddr_storage address = {};
  socklen_t size = sizeof(address);
  if (getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size) != 0) return 0;
  return address.ss_family == AF_INET6 ? ntohs(reinterpret_cast<const sockaddr_in6&>(address).sin6_port)
                                       : ntohs(reinterpret_cast<const sockaddr_in&>(address).sin_port);
}

// Returns the numeric address, because a name may mean another one later.
std::string HostOf(const addrinfo& address) {
  std::array<char, NI_MAXHOST> host = {};
  const int error =
      getnameinfo(address.ai_addr, address.ai_addrlen, host.data(), host.size(), nullptr, 0, NI_NUMERICHOST);
  return error == 0 ? host.data() : "";
}

void SetPort(addrinfo& address, int port) {
  const auto number = htons(static_cast<uint16_t>(port));
  if (address.ai_family == AF_INET6) {
    reinterpret_cast<sockaddr_in6*>(address.ai_addr)->sin6_port = number;
  } else {
    reinterpret_cast<sockaddr_in*>(address.ai_addr)->sin_port = number;
  }
}

// True for an address that a name has but this host does not serve, as ::1 of localhost where IPv6 is off.
bool IsMissingHere(int error) { return error == EADDRNOTAVAIL || error == EAFNOSUPPORT; }

sockaddr_un UnixAddress(const std::string& path) {
  sockaddr_un address = {};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, path.data(), path.size());
  return address;
}

// Makes room for a socket file. Returns the reason why that cannot be done, or an empty text.
std::string RemoveStaleSocket(const std::string& path) {
  struct stat file = {};
  if (lstat(path.c_str(), &file) != 0) return errno == ENOENT ? "" : ErrorText();
  if (!S_ISSOCK(file.st_mode)) return "a file is there that is not a socket";
  const Descriptor probe(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const sockaddr_un address = UnixAddress(path);
  if (connect(probe.number(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0 || errno == EAGAIN) {
    return "another process listens there";
  }
  if (errno != ECONNREFUSED) return ErrorText();
  return unlink(path.c_str()) == 0 ? "" : ErrorText();
}

}  // namespace

absl::StatusOr<std::vector<Listener>> Listener::Open(const ListenAddress& address, mode_t socket_mode) {
  std::vector<Listener> listeners;
  if (address.is_unix()) {
    absl::StatusOr<Listener> listener = OpenUnix(address, socket_mode);
    if (!listener.ok()) return listener.status();
    listeners.push_back(*std::move(listener));
    return listeners;
  }
  addrinfo hints = {};
  hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int error = getaddrinfo(address.host.c_str(), std::to_string(address.port).c_str(), &hints, &found);
  if (error != 0) return CannotListen(address, gai_strerror(error));
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, &freeaddrinfo);
  ListenAddress bound = address;
  for (addrinfo* one = found; one != nullptr; one = one->ai_next) {
    SetPort(*one, bound.port);
    Descriptor socket = BindTcp(*one);
    if (!socket.is_open() && IsMissingHere(errno) && (one->ai_next != nullptr || !listeners.empty())) continue;
    if (!socket.is_open()) return CannotListen(address, ErrorText());
    bound.host = HostOf(*one);
    bound.port = PortOf(socket.number());
    listeners.push_back(Listener(std::move(socket), bound));
  }
  return listeners;
}

absl::StatusOr<Listener> Listener::OpenUnix(const ListenAddress& address, mode_t socket_mode) {
  if (const std::string reason = RemoveStaleSocket(address.path); !reason.empty()) {
    return CannotListen(address, reason);
  }
  Descriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const sockaddr_un name = UnixAddress(address.path);
  // The file gets the mode of the socket less the umask when it is made, so it is never open to more than asked for.
  if (!socket.is_open() || fchmod(socket.number(), socket_mode) != 0 ||
      bind(socket.number(), reinterpret_cast<const sockaddr*>(&name), sizeof(name)) != 0) {
    return CannotListen(address, ErrorText());
  }
  Listener listener(std::move(socket), address);
  if (lstat(address.path.c_str(), &listener.file_) != 0 || chmod(address.path.c_str(), socket_mode) != 0 ||
      listen(listener.socket(), kBacklog) != 0) {
    return CannotListen(address, ErrorText());
  }
  return listener;
}

Listener::~Listener() {
  if (!socket_.is_open() || !address_.is_unix()) return;
  struct stat now = {};
  if (lstat(address_.path.c_str(), &now) == 0 && now.st_ino == file_.st_ino && now.st_dev == file_.st_dev) {
    unlink(address_.path.c_str());
  }
}

Descriptor Listener::Accept() const {
  return Descriptor(accept4(socket_.number(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
}

}  // namespace ricochet::server
