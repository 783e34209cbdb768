#include "server/transport/listener.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <atomic>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <thread>

#include "tests/support/processes/temporary_directory.h"

namespace ricochet::server {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

constexpr mode_t kOwner = 0600;

// A path for a socket in a directory of its own, which is removed at the end.
class SocketPath {
 public:
  std::string path() const { return directory_ / "socket"; }
  ListenAddress address() const { return {.host = "", .path = path()}; }

 private:
  TemporaryDirectory directory_;
};

// Leaves a socket file that nobody listens on, as a killed server does.
void LeaveSocket(const std::string& path) {
  const Descriptor socket(::socket(AF_UNIX, SOCK_STREAM, 0));
  sockaddr_un address = {};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, path.data(), path.size());
  ASSERT_EQ(bind(socket.number(), reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
}

TEST(Listener, TakesThePortThatTheSystemChooses) {
  const auto listeners = Listener::Open({.host = "127.0.0.1", .port = 0, .path = ""}, kOwner);
  ASSERT_TRUE(listeners.ok()) << listeners.status();
  ASSERT_THAT(*listeners, SizeIs(1));
  EXPECT_GT(listeners->front().address().port, 0);
  EXPECT_FALSE(listeners->front().Accept().is_open());
}

TEST(Listener, NameWithSeveralAddressesHasOnePort) {
  const auto listeners = Listener::Open({.host = "localhost", .port = 0, .path = ""}, kOwner);
  ASSERT_TRUE(listeners.ok()) << listeners.status();
  std::set<int> ports;
  for (const Listener& listener : *listeners) ports.insert(listener.address().port);
  EXPECT_THAT(ports, SizeIs(1));
  EXPECT_EQ(listeners->back().address().host, "127.0.0.1");
}

TEST(Listener, SecondOneOnAPortIsRefused) {
  const auto first = Listener::Open({.host = "127.0.0.1", .port = 0, .path = ""}, kOwner);
  ASSERT_TRUE(first.ok()) << first.status();
  const auto second = Listener::Open(first->front().address(), kOwner);
  EXPECT_EQ(second.status().code(), absl::StatusCode::kUnavailable);
  EXPECT_EQ(second.status().message(),
            "cannot listen on " + ToString(first->front().address()) + ": Address already in use");
}

TEST(Listener, AddressOfAnotherHostIsRefused) {
  // This address is reserved for documentation, so that no host has it.
  EXPECT_EQ(Listener::Open({.host = "192.0.2.1", .port = 0, .path = ""}, kOwner).status().message(),
            "cannot listen on 192.0.2.1:0: Cannot assign requested address");
}

TEST(Listener, UnixSocketHasTheModeAskedForAndIsRemoved) {
  const SocketPath at;
  for (const mode_t mode : {0600u, 0660u, 0666u}) {
    {
      const auto listeners = Listener::Open(at.address(), mode);
      ASSERT_TRUE(listeners.ok()) << listeners.status();
      struct stat file = {};
      ASSERT_EQ(lstat(at.path().c_str(), &file), 0);
      EXPECT_TRUE(S_ISSOCK(file.st_mode));
      EXPECT_EQ(file.st_mode & 07777U, mode);
    }
    EXPECT_FALSE(std::filesystem::exists(at.path()));
  }
}

// Between the making of the file and a change of its mode, others could connect.
TEST(Listener, SocketFileIsNeverOpenToMoreThanAskedFor) {
  const SocketPath at;
  // A directory in which every new file keeps the mode with which it was made.
  const mode_t before = umask(0);
  std::atomic<bool> is_done = false;
  std::atomic<unsigned> seen = 0;
  std::thread watcher([&] {
    struct stat file = {};
    while (!is_done) {
      if (lstat(at.path().c_str(), &file) == 0) seen |= file.st_mode & 0777U;
    }
  });
  for (int i = 0; i < 2000; ++i) ASSERT_TRUE(Listener::Open(at.address(), 0600).ok());
  is_done = true;
  watcher.join();
  umask(before);
  EXPECT_EQ(seen & 0077U, 0U);
}

TEST(Listener, StaleSocketIsReplaced) {
  const SocketPath at;
  LeaveSocket(at.path());
  EXPECT_TRUE(Listener::Open(at.address(), kOwner).ok());
}

TEST(Listener, SocketOfALivingServerIsLeftAlone) {
  const SocketPath at;
  const auto first = Listener::Open(at.address(), kOwner);
  ASSERT_TRUE(first.ok()) << first.status();
  EXPECT_THAT(std::string(Listener::Open(at.address(), kOwner).status().message()),
              HasSubstr(": another process listens there"));
  EXPECT_TRUE(std::filesystem::exists(at.path()));
}

TEST(Listener, FileThatIsNotASocketIsLeftAlone) {
  const SocketPath at;
  const std::string kept = at.path() + ".kept";
  std::ofstream(kept) << "precious";
  std::filesystem::create_symlink(kept, at.path());
  EXPECT_THAT(std::string(Listener::Open(at.address(), kOwner).status().message()),
              HasSubstr(": a file is there that is not a socket"));
  EXPECT_TRUE(std::filesystem::is_symlink(at.path()));
  EXPECT_EQ(std::filesystem::file_size(kept), 8U);
}

TEST(Listener, SocketThatReplacedItsOwnIsLeftAlone) {
  const SocketPath at;
  {
    const auto listeners = Listener::Open(at.address(), kOwner);
    ASSERT_TRUE(listeners.ok()) << listeners.status();
    // Moved aside, so that the new file cannot get the number of the old one.
    std::filesystem::rename(at.path(), at.path() + ".old");
    LeaveSocket(at.path());
  }
  EXPECT_TRUE(std::filesystem::exists(at.path()));
}

}  // namespace
}  // namespace ricochet::server
