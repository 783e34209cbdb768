#include "server/listen_address.h"

#include <gtest/gtest.h>

namespace ricochet::server {
namespace {

TEST(ListenAddress, ReadsBackItsOwnText) {
  for (const char* text : {"localhost:0", "127.0.0.1:50051", "[::1]:1", "[fe80::1]:65535", "host-1:80"}) {
    const auto address = ParseListenAddress(text);
    ASSERT_TRUE(address.has_value()) << text;
    EXPECT_EQ(ToString(*address), text);
  }
}

TEST(ListenAddress, LoopbackIsOnlyThisHost) {
  for (const char* text : {"localhost:0", "127.0.0.1:0", "127.255.255.254:0", "[::1]:0"}) {
    EXPECT_TRUE(IsLoopback(*ParseListenAddress(text))) << text;
  }
  for (const char* text : {"0.0.0.0:0", "128.0.0.1:0", "[::]:0", "[::2]:0", "127.0.0.1.example:0"}) {
    EXPECT_FALSE(IsLoopback(*ParseListenAddress(text))) << text;
  }
}

TEST(ListenAddress, SaysWhyItCannotBeBound) {
  // This address is reserved for documentation, so that no host has it.
  EXPECT_EQ(WhyNotBindable({.host = "192.0.2.1", .port = 0}), "Cannot assign requested address");
  EXPECT_EQ(WhyNotBindable({.host = "127.0.0.1", .port = 0}), std::nullopt);
}

}  // namespace
}  // namespace ricochet::server
