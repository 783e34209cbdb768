#include "server/base/listen_address.h"

#include <gtest/gtest.h>

namespace ricochet::server {
namespace {

TEST(ListenAddress, ReadsBackItsOwnText) {
  for (const char* text : {"localhost:0", "127.0.0.1:50051", "[::1]:1", "[fe80::1]:65535", "host-1:80",
                           "unix:/run/ricochet.sock", "unix:relative"}) {
    const auto address = ParseListenAddress(text);
    ASSERT_TRUE(address.has_value()) << text;
    EXPECT_EQ(ToString(*address), text);
  }
}

TEST(ListenAddress, LocalIsOnlyThisHost) {
  for (const char* text : {"localhost:0", "127.0.0.1:0", "127.255.255.254:0", "[::1]:0", "unix:/run/ricochet.sock"}) {
    EXPECT_TRUE(IsLocal(*ParseListenAddress(text))) << text;
  }
  for (const char* text : {"0.0.0.0:0", "128.0.0.1:0", "[::]:0", "[::2]:0", "127.0.0.1.example:0"}) {
    EXPECT_FALSE(IsLocal(*ParseListenAddress(text))) << text;
  }
}

TEST(ListenAddress, PathOfAUnixSocketFitsItsAddress) {
  EXPECT_EQ(ParseListenAddress("unix:/run/a:1"), (ListenAddress{.host = "", .path = "/run/a:1"}));
  EXPECT_EQ(ParseListenAddress("unix:"), std::nullopt);
  // unix(7): 108 bytes, the closing zero included.
  EXPECT_TRUE(ParseListenAddress("unix:" + std::string(107, 'a')).has_value());
  EXPECT_EQ(ParseListenAddress("unix:" + std::string(108, 'a')), std::nullopt);
}

}  // namespace
}  // namespace ricochet::server
