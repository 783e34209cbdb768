#include "server/transport/acceptor.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include "server/security/peer.h"

namespace ricochet::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr int kMostEvents = 64;

// A flood of connections fills neither the log nor the time between the looks at ended connections.
constexpr std::chrono::seconds kBetweenLogLines(1);
constexpr int kMostAtOnce = 64;

// Connections wait in the backlog for this time when descriptors or memory are short.
constexpr milliseconds kPauseWhenShort(50);

bool IsShortage(int error) { return error == EMFILE || error == ENFILE || error == ENOBUFS || error == ENOMEM; }

bool Add(const Descriptor& epoll, int descriptor, uint32_t events) {
  epoll_event event = {.events = events, .data = {.fd = descriptor}};
  return epoll_ctl(epoll.number(), EPOLL_CTL_ADD, descriptor, &event) == 0;
}

}  // namespace

Acceptor::Acceptor(std::vector<Listener> listeners, const ConnectionLimits& limits, const Log& log)
    : listeners_(std::move(listeners)),
      log_(log),
      epoll_(epoll_create1(EPOLL_CLOEXEC)),
      stop_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
      counts_(limits) {}

Acceptor::~Acceptor() { StopAccepting(); }

absl::Status Acceptor::Start(Handler handler) {
  handler_ = std::move(handler);
  bool watched = Add(epoll_, stop_.number(), EPOLLIN);
  for (const Listener& listener : listeners_) watched = watched && Add(epoll_, listener.socket(), EPOLLIN);
  if (!watched) return absl::ErrnoToStatus(errno, "cannot watch the listening sockets");
  thread_ = std::jthread([this] { Run(); });
  return absl::OkStatus();
}

void Acceptor::StopAccepting() {
  const std::lock_guard lock(stopping_);
  if (thread_.joinable()) {
    const uint64_t one = 1;
    static_cast<void>(!write(stop_.number(), &one, sizeof(one)));
    thread_.join();
  }
  listeners_.clear();
}

Acceptor::Counts Acceptor::counts() const {
  const std::lock_guard lock(mutex_);
  return {.open = counts_.in_all(), .accepted = accepted_, .refused = refused_};
}

void Acceptor::Run() {
  std::array<epoll_event, kMostEvents> events = {};
  for (;;) {
    const int count = epoll_wait(epoll_.number(), events.data(), kMostEvents, -1);
    for (int i = 0; i < count; ++i) {
      const epoll_event& event = events.at(static_cast<size_t>(i));
      if (event.data.fd == stop_.number()) return;
      const auto listener = std::find_if(listeners_.begin(), listeners_.end(),
                                         [&event](const Listener& one) { return one.socket() == event.data.fd; });
      if (listener != listeners_.end()) {
        AcceptSome(*listener);
      } else if ((event.events & EPOLLHUP) != 0) {
        Forget(event.data.fd);
      }
    }
  }
}

void Acceptor::AcceptSome(const Listener& listener) {
  for (int taken = 0; taken < kMostAtOnce; ++taken) {
    Descriptor connection = listener.Accept();
    if (connection.is_open()) {
      Admit(std::move(connection));
    } else if (IsShortage(errno)) {
      Refuse("any", std::system_category().message(errno));
      // The next round forgets connections that have ended, which frees descriptors.
      Pause(kPauseWhenShort);
      return;
    } else if (errno == EAGAIN) {
      return;
    }
    // Any other error is that of one connection, which has ended already.
  }
}

void Acceptor::Admit(Descriptor connection) {
  const std::string peer = AddressKeyOfSocket(connection.number());
  const std::string reason = TryAdd(connection, peer);
  if (!reason.empty()) return Refuse(peer, reason);
  ++accepted_;
  log_.Write(LogLevel::kDebug, "connection", {{"peer", peer}});
  handler_(connection.Release());
}

std::string Acceptor::TryAdd(const Descriptor& connection, const std::string& peer) {
  const std::lock_guard lock(mutex_);
  switch (counts_.Add(peer)) {
    case ConnectionCounts::Decision::kTooMany:
      return "too many connections";
    case ConnectionCounts::Decision::kTooManyOfPeer:
      return "too many connections of this peer";
    case ConnectionCounts::Decision::kAccepted:
      break;
  }
  Descriptor second(fcntl(connection.number(), F_DUPFD_CLOEXEC, 0));
  // The end of a connection is always reported; edge-triggered, so that nothing else is reported over and over.
  if (!second.is_open() || !Add(epoll_, second.number(), EPOLLET)) {
    const int error = errno;
    counts_.Remove(peer);
    return std::system_category().message(error);
  }
  const int number = second.number();
  connections_.emplace(number, Connection{std::move(second), peer});
  return "";
}

void Acceptor::Refuse(const std::string& peer, const std::string& reason) {
  ++refused_;
  ++refused_unlogged_;
  const auto now = steady_clock::now();
  if (now < next_log_) return;
  next_log_ = now + kBetweenLogLines;
  log_.Write(LogLevel::kWarning, "connections refused",
             {{"count", std::exchange(refused_unlogged_, 0)}, {"last_peer", peer}, {"last_reason", reason}});
}

void Acceptor::Forget(int number) {
  const std::lock_guard lock(mutex_);
  const auto found = connections_.find(number);
  if (found == connections_.end()) return;
  // The set would go on watching a closed descriptor as long as gRPC holds the other one.
  epoll_ctl(epoll_.number(), EPOLL_CTL_DEL, number, nullptr);
  counts_.Remove(found->second.peer);
  connections_.erase(found);
}

void Acceptor::Pause(milliseconds time) const {
  pollfd stop = {.fd = stop_.number(), .events = POLLIN, .revents = 0};
  poll(&stop, 1, static_cast<int>(time.count()));
}

}  // namespace ricochet::server
