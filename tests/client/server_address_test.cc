// Addresses of servers: what can be reached is taken, and what no retry can reach is refused with the rule.

#include "client/server_address.h"

#include <gtest/gtest.h>

namespace ricochet {
namespace {

TEST(ServerAddress, TakesWhatCanBeReached) {
  for (const char* address : {"host:1", "ricochet.example:50051", "my_host-2:65535", "127.0.0.1:1", "10.0.0.255:50051",
                              "[::1]:50051", "[fe80::1%eth0]:50051", "dns:///host:1", "dns:host:1",
                              "dns://8.8.8.8/host:1", "ipv4:127.0.0.1:1", "ipv6:[::1]:1", "unix:/run/ricochet.sock",
                              "unix:relative", "unix:///run/ricochet.sock", "unix-abstract:ricochet"}) {
    EXPECT_EQ(WhyNoAddress(address), "") << address;
  }
}

TEST(ServerAddress, SaysWhatIsWrongWithTheOthers) {
  const struct {
    const char* address;
    const char* rule;
  } kWrong[] = {
      {"http://127.0.0.1:5", "must be HOST:PORT or unix:PATH, without http://"},
      {"https://host", "must be HOST:PORT or unix:PATH, without https://"},
      {"xds:///host:1", "must be HOST:PORT or unix:PATH, without xds://"},
      {"host", "must have a port, as host:50051"},
      {"[::1]", "must have a port, as [::1]:50051"},
      {"dns:///host", "must have a port, as host:50051"},
      {"ipv4:127.0.0.1", "must have a port, as 127.0.0.1:50051"},
      {":50051", "must have a host before its port"},
      {"host:", "must have a port from 1 to 65535"},
      {"host:0", "must have a port from 1 to 65535"},
      {"host:65536", "must have a port from 1 to 65535"},
      {"host:-1", "must have a port from 1 to 65535"},
      {"host:http", "must have a port from 1 to 65535"},
      {"host:1/path", "must have a port from 1 to 65535"},
      {"300.0.0.1:1", "must have an IPv4 address of four numbers up to 255"},
      {"127.0.0:1", "must have an IPv4 address of four numbers up to 255"},
      {"[::1:5", "must have brackets around an IPv6 address, as [::1]:50051"},
      {"::1:5", "must have brackets around an IPv6 address, as [::1]:50051"},
      {"[::g]:5", "must have an IPv6 address between its brackets"},
      {"user@host:1", "must have a host of letters, digits, dots and hyphens"},
      {"unix:", "must have a path after unix:"},
  };
  for (const auto& wrong : kWrong) EXPECT_EQ(WhyNoAddress(wrong.address), wrong.rule) << wrong.address;
}

}  // namespace
}  // namespace ricochet
