#include "server/security/peer.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <string>
#include <utility>

#include "server/base/descriptor.h"
#include "server/transport/listener.h"

namespace ricochet::server {
namespace {

TEST(Peer, KeyOfAnAddressLeavesThePortOut) {
  EXPECT_EQ(AddressKey("ipv4:192.0.2.1:40000"), "192.0.2.1");
  EXPECT_EQ(AddressKey("unix:"), "unix:");
  EXPECT_EQ(AddressKey("something else"), "something else");
}

TEST(Peer, KeyOfIpv6IsItsNetwork) {
  EXPECT_EQ(AddressKey("ipv6:%5B2001:db8:1:2:3:4:5:6%5D:40000"), "2001:db8:1:2::/64");
  EXPECT_EQ(AddressKey("ipv6:[2001:db8:1:2:ffff::1]:1"), "2001:db8:1:2::/64");
  EXPECT_EQ(AddressKey("ipv6:%5Bfe80::1%25eth0%5D:40000"), "fe80::/64");
  EXPECT_EQ(AddressKey("ipv6:%5B::1%5D:40000"), "::1");
  // A socket for both families shows an IPv4 client in this form.
  EXPECT_EQ(AddressKey("ipv6:%5B::ffff:192.0.2.1%5D:40000"), "192.0.2.1");
}

TEST(Peer, KeyOfAUnixSocketIsTheUser) {
  std::array<int, 2> pair = {};
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, pair.data()), 0);
  const Descriptor one(pair[0]);
  const Descriptor other(pair[1]);
  EXPECT_EQ(AddressKeyOfSocket(one.number()), "unix:" + std::to_string(getuid()));
}

TEST(Peer, AddressOfASocketHasItsPort) {
  for (const auto& [family, start] : {std::pair{AF_INET, "ipv4:127.0.0.1:"}, {AF_INET6, "ipv6:[::1]:"}}) {
    const auto listeners =
        Listener::Open({.host = family == AF_INET ? "127.0.0.1" : "::1", .port = 0, .path = ""}, 0600);
    if (!listeners.ok()) continue;  // A host without IPv6.
    sockaddr_storage address = {};
    socklen_t size = sizeof(address);
    ASSERT_EQ(getsockname(listeners->front().socket(), reinterpret_cast<sockaddr*>(&address), &size), 0);
    const Descriptor client(socket(family, SOCK_STREAM, 0));
    ASSERT_EQ(connect(client.number(), reinterpret_cast<const sockaddr*>(&address), size), 0);
    EXPECT_EQ(AddressOfSocket(client.number()), start + std::to_string(listeners->front().address().port));
  }
  EXPECT_EQ(AddressOfSocket(-1), "unknown");
}

TEST(Peer, KeyOfNoConnectionIsUnknown) { EXPECT_EQ(AddressKeyOfSocket(-1), "unknown"); }

}  // namespace
}  // namespace ricochet::server
