// /healthz on the address of the metrics of a real ricochetd, asked by an HTTP client of few words.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <string>
#include <vector>

#include "ricochet/health.h"
#include "tests/support/processes/eventually.h"
#include "tests/support/processes/server_process.h"

namespace ricochet {
namespace {

using testing::ContainsRegex;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

// Returns a connection, or a socket that is not connected.
int Connect(const std::string& address) {
  const int connection = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int port = std::stoi(address.substr(address.rfind(':') + 1));
  const sockaddr_in to = {.sin_family = AF_INET,
                          .sin_port = htons(static_cast<uint16_t>(port)),
                          .sin_addr = {htonl(INADDR_LOOPBACK)},
                          .sin_zero = {}};
  EXPECT_EQ(connect(connection, reinterpret_cast<const sockaddr*>(&to), sizeof(to)), 0);
  return connection;
}

// Returns the answer with its head; an empty text without one.
std::string Ask(const std::string& address, const std::string& request) {
  const int connection = Connect(address);
  const std::string text = request + " HTTP/1.0\r\n\r\n";
  std::string answer;
  if (send(connection, text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size())) {
    std::array<char, 4096> part = {};
    for (ssize_t count = 0; (count = read(connection, part.data(), part.size())) > 0;) {
      answer.append(part.data(), static_cast<size_t>(count));
    }
  }
  close(connection);
  return answer;
}

TEST(HealthPage, SaysWhatTheHealthOfTheServiceSaysBeforeAndInTheDrain) {
  ServerProcess server({"--metrics", "127.0.0.1:0", "--drain-grace", "60", "--drain-timeout", "0"});
  const std::string page = server.LoggedAddress("metrics");
  const auto health = [&] { return CheckHealth({.target = server.address()}, "ricochet.v1.ImpactService"); };
  ASSERT_EQ(health().value(), Health::kServing);
  EXPECT_THAT(Ask(page, "GET /healthz"), StartsWith("HTTP/1.1 200 "));
  EXPECT_THAT(Ask(page, "GET /healthz"), EndsWith("\r\n\r\nSERVING\n"));
  EXPECT_THAT(Ask(page, "HEAD /healthz"), EndsWith("\r\n\r\n"));
  EXPECT_THAT(Ask(page, "GET /metrics"), HasSubstr("\nricochet_serving 1\n"));
  server.Terminate();
  ASSERT_TRUE(Eventually([&] { return health().value() == Health::kNotServing; }));
  EXPECT_THAT(Ask(page, "GET /healthz"), StartsWith("HTTP/1.1 503 "));
  EXPECT_THAT(Ask(page, "GET /healthz"), EndsWith("\r\n\r\nNOT_SERVING\n"));
  EXPECT_THAT(Ask(page, "GET /metrics"), HasSubstr("\nricochet_serving 0\n"));
  server.Terminate();  // The second signal ends the grace.
  EXPECT_EQ(server.Wait(), 0);
}

TEST(HealthPage, AnswersBesideConnectionsThatSendNothing) {
  const ServerProcess server({"--metrics", "127.0.0.1:0"});
  const std::string page = server.LoggedAddress("metrics");
  std::vector<int> silent;
  for (int i = 0; i < 20; ++i) silent.push_back(Connect(page));
  EXPECT_THAT(Ask(page, "GET /healthz"), StartsWith("HTTP/1.1 200 "));
  // The answer did not wait for the end of one of them: reading finds nothing, not even an end.
  char byte = 0;
  EXPECT_EQ(recv(silent.front(), &byte, 1, MSG_DONTWAIT), -1);
  EXPECT_EQ(errno, EAGAIN);
  for (const int connection : silent) close(connection);
}

TEST(HealthPage, TakesNothingElse) {
  const ServerProcess server({"--metrics", "127.0.0.1:0"});
  const std::string page = server.LoggedAddress("metrics");
  EXPECT_THAT(Ask(page, "POST /healthz"), StartsWith("HTTP/1.1 405 "));
  for (const std::string path : {"/", "/health", "/healthz/x", "/metrics/x", "/../etc/passwd"}) {
    EXPECT_THAT(Ask(page, "GET " + path), ContainsRegex("^HTTP/1.. 40[04] ")) << path;
  }
}

}  // namespace
}  // namespace ricochet
