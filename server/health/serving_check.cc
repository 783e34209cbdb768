#include "server/health/serving_check.h"

#include <netdb.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/base/descriptor.h"

namespace ricochet::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds kPause(5);

// Returns a socket that is connected within `patience`, or no descriptor; errno then tells why.
Descriptor Connect(const sockaddr* address, socklen_t length, milliseconds patience) {
  Descriptor connection(socket(address->sa_family, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (!connection.is_open()) return {};
  const auto seconds = std::chrono::floor<std::chrono::seconds>(patience);
  const timeval limit = {.tv_sec = seconds.count(), .tv_usec = std::chrono::microseconds(patience - seconds).count()};
  setsockopt(connection.number(), SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof(limit));
  return connect(connection.number(), address, length) == 0 ? std::move(connection) : Descriptor();
}

Descriptor ConnectUnix(const std::string& path, milliseconds patience) {
  sockaddr_un address = {};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, sizeof(address.sun_path) - 1);
  return Connect(reinterpret_cast<const sockaddr*>(&address), sizeof(address), patience);
}

Descriptor ConnectTcp(const ListenAddress& to, milliseconds patience) {
  addrinfo hints = {};
  hints.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (getaddrinfo(to.host.c_str(), std::to_string(to.port).c_str(), &hints, &found) != 0) return {};
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> first(found, freeaddrinfo);
  return Connect(first->ai_addr, first->ai_addrlen, patience);
}

absl::Status CannotServe(const ListenAddress& address, const std::string& reason) {
  return absl::UnavailableError(absl::StrCat(ToString(address), ": ", reason));
}

int64_t Noticed(const Acceptor& acceptor) {
  const Acceptor::Counts counts = acceptor.counts();
  return counts.accepted + counts.refused;
}

// The kernel completes a connection although nobody accepts it, so the acceptor's own counts have to tell.
absl::Status CheckAddress(const ListenAddress& address, const Acceptor& acceptor, milliseconds patience,
                          const std::stop_token& stop) {
  const int64_t before = Noticed(acceptor);
  const Descriptor connection = address.is_unix() ? ConnectUnix(address.path, patience) : ConnectTcp(address, patience);
  if (!connection.is_open()) return CannotServe(address, absl::StrCat("cannot connect: ", std::strerror(errno)));
  const auto end = steady_clock::now() + patience;
  while (Noticed(acceptor) == before && !stop.stop_requested()) {
    if (steady_clock::now() >= end) {
      return CannotServe(address, absl::StrCat("no connection was accepted for ", patience.count(), " ms"));
    }
    std::this_thread::sleep_for(kPause);
  }
  return absl::OkStatus();
}

absl::Status CheckScheduler(Scheduler& scheduler, milliseconds patience, const std::stop_token& stop) {
  const ComputeRequest request = {.peer = "watchdog",
                                  .deadline = steady_clock::now() + patience,
                                  .is_gone = [&stop] { return stop.stop_requested(); },
                                  .cost = RequestCost()};
  const absl::Status computed = scheduler.Compute(request, [] {});
  if (!absl::IsDeadlineExceeded(computed)) return absl::OkStatus();
  return absl::UnavailableError(absl::StrCat("no call got its turn to compute for ", patience.count(), " ms"));
}

}  // namespace

absl::Status CheckServing(const std::vector<ListenAddress>& addresses, const Acceptor& acceptor, Scheduler& scheduler,
                          milliseconds patience, const std::stop_token& stop) {
  for (const ListenAddress& address : addresses) {
    if (absl::Status status = CheckAddress(address, acceptor, patience, stop); !status.ok()) return status;
  }
  return CheckScheduler(scheduler, patience, stop);
}

}  // namespace ricochet::server
