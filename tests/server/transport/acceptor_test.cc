#include "server/transport/acceptor.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>

#include <array>
#include <filesystem>
#include <mutex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/processes/eventually.h"

namespace ricochet::server {
namespace {

using std::chrono::seconds;
using std::chrono::steady_clock;
using testing::HasSubstr;

size_t OpenDescriptors() {
  const std::filesystem::directory_iterator all("/proc/self/fd");
  return static_cast<size_t>(std::distance(begin(all), end(all)));
}

// An acceptor on a loopback port whose handler keeps the connections.
class Accepting {
 public:
  explicit Accepting(const ConnectionLimits& limits)
      : log_(LogFormat::kText, LogLevel::kInfo, logged_),
        listeners_(*Listener::Open({.host = "127.0.0.1", .port = 0, .path = ""}, 0600)),
        port_(listeners_.front().address().port),
        acceptor_(std::move(listeners_), limits, log_) {
    EXPECT_TRUE(acceptor_.Start([this](int descriptor) { Keep(descriptor); }).ok());
  }

  Acceptor& acceptor() { return acceptor_; }

  // Connects from 127.0.0.`host`.
  Descriptor Connect(int host = 1) const {
    Descriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    const sockaddr_in from = {.sin_family = AF_INET,
                              .sin_port = 0,
                              .sin_addr = {htonl(0x7F000000U + static_cast<unsigned>(host))},
                              .sin_zero = {}};
    EXPECT_EQ(bind(socket.number(), reinterpret_cast<const sockaddr*>(&from), sizeof(from)), 0);
    const sockaddr_in to = {.sin_family = AF_INET,
                            .sin_port = htons(static_cast<uint16_t>(port_)),
                            .sin_addr = {htonl(INADDR_LOOPBACK)},
                            .sin_zero = {}};
    EXPECT_EQ(connect(socket.number(), reinterpret_cast<const sockaddr*>(&to), sizeof(to)), 0);
    return socket;
  }

  // Ends the connections as gRPC does: it shuts them down, then closes its descriptor.
  void DropAll() {
    const std::lock_guard lock(mutex_);
    for (const Descriptor& one : kept_) shutdown(one.number(), SHUT_RDWR);
    kept_.clear();
  }

  bool OpenBecomes(int count) {
    return Eventually([&] { return acceptor_.counts().open == count; });
  }
  bool RefusedReach(int64_t count) {
    return Eventually([&] { return acceptor_.counts().refused >= count; });
  }

  std::string log() const { return logged_.str(); }

 private:
  void Keep(int descriptor) {
    const std::lock_guard lock(mutex_);
    kept_.push_back(Descriptor(descriptor));
  }

  std::ostringstream logged_;
  Log log_;
  std::vector<Listener> listeners_;
  int port_;
  std::mutex mutex_;
  std::vector<Descriptor> kept_;
  Acceptor acceptor_;
};

// Returns true if the other end closes the connection within 20 s.
bool IsClosed(const Descriptor& connection) {
  pollfd poll_for = {.fd = connection.number(), .events = POLLIN, .revents = 0};
  if (poll(&poll_for, 1, 20'000) != 1) return false;
  std::array<char, 1> byte = {};
  return recv(connection.number(), byte.data(), byte.size(), 0) <= 0;
}

TEST(Acceptor, CountsConnectionsUntilTheyEnd) {
  Accepting server({.in_all = 10, .per_peer = 10});
  Descriptor one = server.Connect();
  Descriptor other = server.Connect();
  EXPECT_TRUE(server.OpenBecomes(2));
  // A connection has ended when this side has closed it, too, and not when the client does.
  one = Descriptor();
  server.DropAll();
  EXPECT_TRUE(server.OpenBecomes(0));
  EXPECT_TRUE(IsClosed(other));
  EXPECT_EQ(server.acceptor().counts().accepted, 2);
  EXPECT_EQ(server.acceptor().counts().refused, 0);
}

TEST(Acceptor, DescriptorsComeBack) {
  Accepting server({.in_all = 100, .per_peer = 100});
  const size_t before = OpenDescriptors();
  for (int round = 0; round < 3; ++round) {
    std::vector<Descriptor> clients;
    for (int i = 0; i < 50; ++i) clients.push_back(server.Connect());
    EXPECT_TRUE(server.OpenBecomes(50));
    EXPECT_EQ(OpenDescriptors(), before + 3 * 50);
    server.DropAll();
    clients.clear();
    EXPECT_TRUE(server.OpenBecomes(0));
    EXPECT_EQ(OpenDescriptors(), before);
  }
}

TEST(Acceptor, RefusesAboveTheLimitInAllUntilOneEnds) {
  Accepting server({.in_all = 2, .per_peer = 2});
  const Descriptor first = server.Connect(1);
  const Descriptor second = server.Connect(2);
  EXPECT_TRUE(IsClosed(server.Connect(3)));
  EXPECT_TRUE(server.RefusedReach(1));
  EXPECT_THAT(server.log(),
              HasSubstr("connections refused count=1 last_peer=127.0.0.3 last_reason=\"too many connections\""));
  server.DropAll();
  EXPECT_TRUE(server.OpenBecomes(0));
  const Descriptor third = server.Connect(3);
  EXPECT_TRUE(server.OpenBecomes(1));
}

TEST(Acceptor, RefusesAPeerAboveItsLimitAndNoOther) {
  Accepting server({.in_all = 10, .per_peer = 2});
  const Descriptor first = server.Connect(1);
  const Descriptor second = server.Connect(1);
  EXPECT_TRUE(IsClosed(server.Connect(1)));
  const Descriptor of_other = server.Connect(2);
  EXPECT_TRUE(server.OpenBecomes(3));
  EXPECT_TRUE(server.RefusedReach(1));
  EXPECT_THAT(server.log(), HasSubstr("last_peer=127.0.0.1 last_reason=\"too many connections of this peer\""));
}

TEST(Acceptor, FloodOfRefusalsIsFewLines) {
  Accepting server({.in_all = 1, .per_peer = 1});
  const Descriptor kept = server.Connect();
  const auto start = steady_clock::now();
  for (int i = 0; i < 200; ++i) EXPECT_TRUE(IsClosed(server.Connect()));
  EXPECT_TRUE(server.RefusedReach(200));
  const auto lines = static_cast<size_t>(std::ranges::count(server.log(), '\n'));
  EXPECT_LE(lines, 2 + static_cast<size_t>(std::chrono::duration_cast<seconds>(steady_clock::now() - start).count()));
}

TEST(Acceptor, ServesAgainAfterDescriptorsRanOut) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer checks virtual tables through a pipe, and ends a process that can open none";
#endif
  Accepting server({.in_all = 1000, .per_peer = 1000});
  rlimit limit = {};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &limit), 0);
  // Room for the client's socket, and for no descriptor of the server.
  std::vector<Descriptor> fill;
  const rlimit low = {.rlim_cur = 256, .rlim_max = limit.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &low), 0);
  const Descriptor client = server.Connect();
  EXPECT_TRUE(server.OpenBecomes(1));
  while (fill.empty() || fill.back().is_open()) fill.push_back(Descriptor(fcntl(0, F_DUPFD_CLOEXEC, 0)));
  fill.pop_back();
  fill.pop_back();
  const Descriptor waiting = server.Connect();
  EXPECT_TRUE(server.RefusedReach(1));
  EXPECT_THAT(server.log(), HasSubstr("last_reason=\"Too many open files\""));
  fill.clear();
  EXPECT_TRUE(server.OpenBecomes(2));
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &limit), 0);
}

TEST(Acceptor, StoppedOneRefusesAndKeepsWhatIsOpen) {
  Accepting server({.in_all = 10, .per_peer = 10});
  const Descriptor client = server.Connect();
  EXPECT_TRUE(server.OpenBecomes(1));
  server.acceptor().StopAccepting();
  server.acceptor().StopAccepting();
  pollfd still_open = {.fd = client.number(), .events = POLLIN, .revents = 0};
  EXPECT_EQ(poll(&still_open, 1, 0), 0);
  server.DropAll();
  EXPECT_TRUE(IsClosed(client));
}

}  // namespace
}  // namespace ricochet::server
