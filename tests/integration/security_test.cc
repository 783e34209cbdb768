// TLS, client certificates and tokens of a real ricochetd, with certificates made for the test.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <openssl/sha.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "ricochet/client.h"
#include "ricochet/health.h"
#include "tests/support/processes/eventually.h"
#include "tests/support/processes/server_process.h"
#include "tests/support/processes/test_certificates.h"

namespace ricochet {
namespace {

using absl::StatusCode;
using std::chrono::seconds;
using std::chrono::steady_clock;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr char kHost[] = "ricochet.test";

Scene AnyScene() {
  Scene scene;
  scene.system = Pendulum{.inertia_kg_m2 = 1.0, .a_m = 0.3, .b_m = 1.0, .omega_minus_rad_s = -1.0};
  scene.restitution = EnergeticCoefficient{1.0};
  return scene;
}

// A connection of TCP.
class Connection {
 public:
  explicit Connection(int port) : socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address = {.sin_family = AF_INET,
                           .sin_port = htons(static_cast<uint16_t>(port)),
                           .sin_addr = {htonl(INADDR_LOOPBACK)},
                           .sin_zero = {}};
    EXPECT_EQ(connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
    socklen_t size = sizeof(address);
    getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
  }
  ~Connection() { close(socket_); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  // The address of this end, as the log of the other end names it.
  std::string peer() const { return "ipv4:127.0.0.1:" + std::to_string(port_); }
  void Send(const std::string& bytes) const {
    EXPECT_EQ(write(socket_, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  // Sends no more, and reads all that the other end still sends.
  void ReadToTheEnd() const {
    shutdown(socket_, SHUT_WR);
    std::array<char, 256> some = {};
    while (read(socket_, some.data(), some.size()) > 0) {
    }
  }

 private:
  int socket_;
  int port_ = 0;
};

// Solves by a client, and so by a connection, of its own.
absl::Status Solve(const std::string& target, const SecurityOptions& security) {
  // A user agent of its own keeps gRPC from sharing the connection of another client.
  static int clients = 0;
  const auto client = Client::Connect({.target = target,
                                       .deadline = seconds(10),
                                       .retry = {.max_attempts = 1},
                                       .security = security,
                                       .user_agent = "test/" + std::to_string(++clients)});
  return client.ok() ? client->Solve({.scene = AnyScene()}).status() : client.status();
}

StatusCode SolveCode(const ServerProcess& server, const SecurityOptions& security) {
  return Solve(server.address(), security).code();
}

std::string Sha256(const std::string& text) {
  std::array<unsigned char, SHA256_DIGEST_LENGTH> hash = {};
  SHA256(reinterpret_cast<const unsigned char*>(text.data()), text.size(), hash.data());
  std::string digits;
  for (const unsigned char byte : hash) {
    std::array<char, 3> two = {};
    std::snprintf(two.data(), two.size(), "%02x", byte);
    digits += two.data();
  }
  return digits;
}

std::string LineOf(const std::string& name, const std::string& token, const std::string& scopes) {
  return name + " sha256:" + Sha256(token) + " " + scopes + "\n";
}

class Tls : public testing::Test {
 protected:
  Tls() { files_.Make("server", kHost); }

  std::vector<std::string> Flags(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> flags = {"--tls-cert", files_ / "server.pem", "--tls-key", files_ / "server.key"};
    flags.insert(flags.end(), more.begin(), more.end());
    return flags;
  }
  SecurityOptions Trusting(const std::string& authority = "ca") const {
    return {.tls = true, .tls_ca = files_ / (authority + ".pem"), .server_name = kHost};
  }
  SecurityOptions WithCertificate(const std::string& name) const {
    SecurityOptions security = Trusting();
    security.tls_cert = files_ / (name + ".pem");
    security.tls_key = files_ / (name + ".key");
    return security;
  }

  TestCertificates files_;
};

TEST_F(Tls, ServesClientsThatTrustItsAuthority) {
  const ServerProcess server(Flags());
  EXPECT_EQ(SolveCode(server, Trusting()), StatusCode::kOk);
  EXPECT_THAT(server.log(), HasSubstr("security=TLS "));
  EXPECT_THAT(server.log(), HasSubstr("certificate read subject=\"CN = ricochet.test\" valid_until="));
}

TEST_F(Tls, ClientDistrustsAnotherAuthority) {
  files_.MakeAuthority("other");
  const ServerProcess server(Flags());
  EXPECT_EQ(SolveCode(server, Trusting("other")), StatusCode::kFailedPrecondition);
}

TEST_F(Tls, ClientDistrustsAnotherName) {
  const ServerProcess server(Flags());
  SecurityOptions security = Trusting();
  security.server_name = "other.test";
  EXPECT_EQ(SolveCode(server, security), StatusCode::kFailedPrecondition);
}

TEST_F(Tls, ClientDistrustsAnExpiredCertificate) {
  files_.Make("server", kHost, "ca", -1);
  const ServerProcess server(Flags());
  EXPECT_EQ(SolveCode(server, Trusting()), StatusCode::kFailedPrecondition);
}

TEST_F(Tls, PlaintextIsRefused) {
  const ServerProcess server(Flags());
  EXPECT_EQ(SolveCode(server, {}), StatusCode::kUnavailable);
}

// A list of servers is still gone through to the end: the one that is trusted answers.
TEST_F(Tls, ServerThatIsNotTrustedLeavesTheCallToTheNext) {
  files_.MakeAuthority("other");
  files_.Make("stranger", kHost, "other");
  const ServerProcess stranger({"--tls-cert", files_ / "stranger.pem", "--tls-key", files_ / "stranger.key"});
  const ServerProcess server(Flags());
  const std::string both = stranger.address() + "," + server.address();
  EXPECT_EQ(Solve(both, Trusting()).code(), StatusCode::kOk);
  const Client client = Client::Connect({.target = both, .security = Trusting(), .user_agent = "list"}).value();
  for (const auto& chunk : client.Sweep({.grid = {.scene = AnyScene()}, .columns = {"coefficients.newton"}})) {
    EXPECT_TRUE(chunk.ok()) << chunk.status();
  }
}

TEST_F(Tls, NewCertificateIsUsedWithoutRestart) {
  files_.MakeAuthority("next");
  files_.Make("new", kHost, "next");
  const ServerProcess server(Flags());
  ASSERT_EQ(SolveCode(server, Trusting()), StatusCode::kOk);
  files_.Replace("server", "new");
  EXPECT_TRUE(Eventually([&] { return SolveCode(server, Trusting("next")) == StatusCode::kOk; }));
  EXPECT_EQ(SolveCode(server, Trusting()), StatusCode::kFailedPrecondition);
}

TEST_F(Tls, BrokenNewCertificateLeavesTheOldOneInUse) {
  const ServerProcess server(Flags());
  ASSERT_EQ(SolveCode(server, Trusting()), StatusCode::kOk);
  files_.Write("server.pem", "not a certificate");
  EXPECT_EQ(SolveCode(server, Trusting()), StatusCode::kOk);
  EXPECT_THAT(server.WaitForLog("certificate not read"), HasSubstr("holds no certificate in PEM form"));
  files_.Make("new", kHost);
  // The new certificate is here before its key, as when files are copied one after the other.
  std::filesystem::copy_file(files_ / "new.pem", files_ / "server.pem",
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_EQ(SolveCode(server, Trusting()), StatusCode::kOk);
  EXPECT_THAT(server.WaitForLog("is not that of the certificate"), HasSubstr("certificate not read"));
}

TEST_F(Tls, StartNamesTheFileThatIsWrong) {
  files_.MakeAuthority("other");
  files_.Write("empty", "");
  const auto reason_of = [](const std::vector<std::string>& flags) {
    std::vector<std::string> all = {"--listen", "127.0.0.1:0"};
    all.insert(all.end(), flags.begin(), flags.end());
    const Ending ending = RunServerToEnd(all);
    EXPECT_EQ(ending.exit_status, 1);
    return ending.output;
  };
  const std::string certificate = files_ / "server.pem";
  EXPECT_THAT(reason_of({"--tls-cert", certificate, "--tls-key", files_ / "missing"}),
              HasSubstr("cannot read " + files_ / "missing"));
  EXPECT_THAT(reason_of({"--tls-cert", files_ / "empty", "--tls-key", files_ / "server.key"}),
              HasSubstr(files_ / "empty" + " holds no certificate"));
  EXPECT_THAT(reason_of({"--tls-cert", certificate, "--tls-key", files_ / "other.key"}),
              HasSubstr("is not that of the certificate"));
  EXPECT_THAT(reason_of(Flags({"--tls-client-ca", files_ / "empty"})),
              HasSubstr(files_ / "empty" + " holds no certificate"));
  EXPECT_THAT(reason_of(Flags({"--tokens", files_ / "empty"})),
              HasSubstr(files_ / "empty" + ": no line names a caller"));
}

TEST_F(Tls, GoodCertificatesGiveNoErrorAndServeEveryAddress) {
  const ServerProcess server(Flags({"--reflection", "127.0.0.1:0"}));
  EXPECT_THAT(server.log(), Not(HasSubstr("Z error ")));
  for (const std::string& address : {server.address(), server.LoggedAddress("reflection")}) {
    const auto health = CheckHealth({.target = address, .security = Trusting()}, "");
    ASSERT_TRUE(health.ok()) << address << ": " << health.status();
    EXPECT_EQ(*health, Health::kServing);
  }
}

TEST_F(Tls, CertificateThatTlsRefusesIsAnErrorAtTheStartAndLeavesTheOldOneInUse) {
  files_.Make("weak", kHost, "ca", 1, "rsa:1024");
  const std::string reason = "weak.pem cannot be used for TLS: ee key too small";
  const Ending ending =
      RunServerToEnd({"--listen", "127.0.0.1:0", "--tls-cert", files_ / "weak.pem", "--tls-key", files_ / "weak.key"});
  EXPECT_EQ(ending.exit_status, 1);
  EXPECT_THAT(ending.output, HasSubstr(reason));
  const ServerProcess server(Flags());
  files_.Replace("server", "weak");
  EXPECT_EQ(SolveCode(server, Trusting()), StatusCode::kOk);
  EXPECT_THAT(server.WaitForLog("cannot be used for TLS"), HasSubstr("error certificate not read"));
  EXPECT_EQ(SolveCode(server, Trusting()), StatusCode::kOk);
}

// A connection without TLS from a port of its own, which it returns as a log names it.
std::string Speak(int port, const std::string& bytes) {
  const Connection connection(port);
  connection.Send(bytes);
  connection.ReadToTheEnd();
  return connection.peer();
}

TEST_F(Tls, FailedHandshakeNamesItsPeer) {
  const ServerProcess server(Flags({"--log-level", "debug"}));
  const std::string prober = Speak(server.port(), "");
  const std::string talker = Speak(server.port(), "GET / HTTP/1.0\r\n\r\n");
  EXPECT_THAT(server.WaitForLog("warning handshake failed peer=" + talker + " "),
              HasSubstr("warning handshake failed peer=" + talker + " reason="));
  // One who says nothing only looks whether the port is open, as the server's own watchdog does.
  EXPECT_THAT(server.WaitForLog("failed peer=" + prober + " "),
              HasSubstr("debug handshake failed peer=" + prober + " "));
  ASSERT_EQ(SolveCode(server, Trusting()), StatusCode::kOk);
  EXPECT_THAT(server.log(), Not(HasSubstr("Z error ")));
}

TEST_F(Tls, HalfOpenHandshakesLeaveRoomForOthers) {
  const ServerProcess server(Flags({"--max-connections", "20"}));
  std::vector<std::unique_ptr<Connection>> silent;
  for (int i = 0; i < 10; ++i) {
    silent.push_back(std::make_unique<Connection>(server.port()));
    // The start of a TLS record that never goes on.
    silent.back()->Send("\x16\x03\x01\x02");
  }
  EXPECT_EQ(SolveCode(server, Trusting()), StatusCode::kOk);
}

class MutualTls : public Tls {
 protected:
  MutualTls() { files_.Make("client", "lab.test"); }
  std::vector<std::string> Flags(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> flags = Tls::Flags({"--tls-client-ca", files_ / "ca.pem"});
    flags.insert(flags.end(), more.begin(), more.end());
    return flags;
  }
};

TEST_F(MutualTls, ServesClientsWithACertificate) {
  const ServerProcess server(Flags());
  EXPECT_EQ(SolveCode(server, WithCertificate("client")), StatusCode::kOk);
}

TEST_F(MutualTls, RefusesClientsWithoutACertificate) {
  const ServerProcess server(Flags());
  EXPECT_EQ(SolveCode(server, Trusting()), StatusCode::kUnavailable);
  const std::string log = server.WaitForLog("certificate required");
  EXPECT_THAT(log, HasSubstr("warning handshake failed peer=ipv4:127.0.0.1:"));
  EXPECT_THAT(log, HasSubstr(" reason=\"alert to the client: certificate required\""));
}

TEST_F(MutualTls, RefusesCertificatesOfAnotherAuthorityAndExpiredOnes) {
  files_.MakeAuthority("other");
  files_.Make("stranger", "lab.test", "other");
  files_.Make("old", "lab.test", "ca", -1);
  const ServerProcess server(Flags());
  EXPECT_EQ(SolveCode(server, WithCertificate("stranger")), StatusCode::kUnavailable);
  // Our client knows that this one has ended, and does not show it.
  EXPECT_EQ(SolveCode(server, WithCertificate("old")), StatusCode::kInvalidArgument);
  // Openssl's does.
  const std::string shown = "openssl s_client -tls1_2 -connect 127.0.0.1:" + std::to_string(server.port()) + " -cert " +
                            (files_ / "old.pem") + " -key " + (files_ / "old.key") + " </dev/null >/dev/null 2>&1";
  EXPECT_NE(std::system(shown.c_str()), 0);
  EXPECT_THAT(server.WaitForLog("has expired"),
              HasSubstr("reason=\"certificate of the client: certificate has expired\""));
}

TEST_F(MutualTls, CertificateCountsByItsNameWhereThereAreTokens) {
  files_.Make("other", "stranger.test");
  files_.Write("tokens", "lab.test certificate solve\n");
  const ServerProcess server(Flags({"--tokens", files_ / "tokens"}));
  EXPECT_EQ(SolveCode(server, WithCertificate("client")), StatusCode::kOk);
  EXPECT_EQ(SolveCode(server, WithCertificate("other")), StatusCode::kUnauthenticated);
  EXPECT_THAT(server.WaitForLog("call refused"), HasSubstr("certificate=stranger.test"));
  EXPECT_THAT(server.log(), HasSubstr("reason=\"no token, and no line for the certificate\""));
}

class Tokens : public Tls {
 protected:
  Tokens() { files_.Write("tokens", LineOf("lab", "secret", "solve") + LineOf("monitor", "other", "info")); }
  SecurityOptions Bearing(const std::string& token) const {
    SecurityOptions security = Trusting();
    security.token = token;
    return security;
  }
};

TEST_F(Tokens, DecideWhoMayCallWhat) {
  const ServerProcess server(Flags({"--tokens", files_ / "tokens"}));
  EXPECT_EQ(SolveCode(server, Bearing("secret")), StatusCode::kOk);
  const absl::Status missing = Solve(server.address(), Trusting());
  EXPECT_EQ(missing.code(), StatusCode::kUnauthenticated);
  EXPECT_THAT(std::string(missing.message()),
              StartsWith("the call is not authenticated: the server takes a token (security.token"));
  const absl::Status wrong = Solve(server.address(), Bearing("Secret"));
  EXPECT_EQ(wrong.code(), StatusCode::kUnauthenticated);
  EXPECT_EQ(wrong.message(), missing.message());
  const absl::Status no_scope = Solve(server.address(), Bearing("other"));
  EXPECT_EQ(no_scope.code(), StatusCode::kPermissionDenied);
  EXPECT_THAT(std::string(no_scope.message()),
              StartsWith("the caller may not call this method: the scopes of this client's"));
  const std::string log = server.WaitForLog("scope solve is missing");
  EXPECT_THAT(log, HasSubstr("reason=\"no token\""));
  EXPECT_THAT(log, HasSubstr("reason=\"unknown token\""));
  EXPECT_THAT(log, HasSubstr("method=/ricochet.v1.ImpactService/Solve status=PERMISSION_DENIED"));
  EXPECT_THAT(log, Not(HasSubstr("secret")));
  EXPECT_THAT(log, Not(HasSubstr("Secret")));
}

TEST_F(Tokens, HealthNeedsNone) {
  const ServerProcess server(Flags({"--tokens", files_ / "tokens"}));
  const auto health = CheckHealth({.target = server.address(), .security = Trusting()}, "");
  ASSERT_TRUE(health.ok()) << health.status();
  EXPECT_EQ(*health, Health::kServing);
}

TEST_F(Tokens, ChangeWithoutRestart) {
  const ServerProcess server(Flags({"--tokens", files_ / "tokens"}));
  ASSERT_EQ(SolveCode(server, Bearing("secret")), StatusCode::kOk);
  files_.Write("tokens", LineOf("lab", "fresh", "all"));
  EXPECT_TRUE(Eventually([&] { return SolveCode(server, Bearing("fresh")) == StatusCode::kOk; }));
  EXPECT_EQ(SolveCode(server, Bearing("secret")), StatusCode::kUnauthenticated);
  files_.Write("tokens", "lab fresh all\n");
  EXPECT_TRUE(Eventually([&] {
    return SolveCode(server, Bearing("fresh")) == StatusCode::kOk &&
           server.log().find("tokens not read") != std::string::npos;
  }));
  EXPECT_EQ(SolveCode(server, Bearing("fresh")), StatusCode::kOk);
  EXPECT_THAT(server.log(), Not(HasSubstr("fresh")));
}

TEST_F(Tokens, ClientReadsItsTokenAgain) {
  const ServerProcess server(Flags({"--tokens", files_ / "tokens"}));
  files_.Write("token", "wrong\n");
  SecurityOptions security = Trusting();
  security.token_file = files_ / "token";
  const auto client = Client::Connect({.target = server.address(), .security = security, .user_agent = "reader"});
  ASSERT_TRUE(client.ok()) << client.status();
  EXPECT_EQ(client->Solve({.scene = AnyScene()}).status().code(), StatusCode::kUnauthenticated);
  files_.Write("token", "secret\n");
  EXPECT_TRUE(client->Solve({.scene = AnyScene()}).ok());
}

TEST_F(Tokens, CountOnLoopbackAndUnixSocketsToo) {
  const std::string target = "unix:" + files_ / "socket";
  const ServerProcess server({"--listen", "127.0.0.1:0," + target, "--tokens", files_ / "tokens"});
  for (const std::string& one : {server.address(), target}) {
    EXPECT_EQ(Solve(one, {.token = "secret"}).code(), StatusCode::kOk) << one;
    EXPECT_EQ(Solve(one, {.token = "wrong"}).code(), StatusCode::kUnauthenticated) << one;
    EXPECT_EQ(Solve(one, {}).code(), StatusCode::kUnauthenticated) << one;
  }
}

TEST_F(Tokens, OneConnectionCarriesSeveralCallers) {
  files_.Write("tokens", LineOf("lab", "secret", "solve") + LineOf("monitor", "other", "info"));
  const ServerProcess server(Flags({"--tokens", files_ / "tokens"}));
  files_.Write("token", "secret");
  SecurityOptions security = Trusting();
  security.token_file = files_ / "token";
  const auto client = Client::Connect({.target = server.address(), .security = security, .user_agent = "changing"});
  ASSERT_TRUE(client.ok()) << client.status();
  EXPECT_EQ(client->Solve({.scene = AnyScene()}).status().code(), StatusCode::kOk);
  files_.Write("token", "other");
  EXPECT_EQ(client->Solve({.scene = AnyScene()}).status().code(), StatusCode::kPermissionDenied);
  files_.Write("token", "unknown");
  EXPECT_EQ(client->Solve({.scene = AnyScene()}).status().code(), StatusCode::kUnauthenticated);
}

// Starts a long sweep and reads its first chunk. The sweep runs as long as what is returned lives.
struct StartedSweep {
  StartedSweep(const std::string& target, const std::string& token)
      : stream(Client::Connect({.target = target,
                                .retry = {.max_attempts = 1},
                                .security = {.token = token},
                                .user_agent = "sweeper/" + token})
                   .value()
                   .Sweep({.grid = {.scene = AnyScene(),
                                    .axes = {{"friction.kinetic_coefficient", Linspace{0.0, 0.4, 1'000'000'000}}}},
                           .columns = {"coefficients.newton"}})),
        at(stream.begin()),
        first(at->status()) {}

  // Reads on until the sweep fails or the time is over. Returns why it failed.
  absl::Status ReadFor(std::chrono::seconds time) {
    for (const auto end = std::chrono::steady_clock::now() + time;
         at != stream.end() && std::chrono::steady_clock::now() < end; ++at) {
      if (!at->ok()) return at->status();
    }
    return absl::OkStatus();
  }

  SweepStream stream;
  decltype(stream.begin()) at;
  absl::Status first;
};

TEST_F(Tokens, AStreamEndsWhenItsTokenOrItsScopeIsRemoved) {
  files_.Write("tokens", LineOf("lab", "secret", "sweep") + LineOf("shop", "other", "sweep") +
                             LineOf("office", "third", "sweep,solve"));
  const ServerProcess server({"--tokens", files_ / "tokens"});
  StartedSweep removed(server.address(), "secret");
  StartedSweep kept(server.address(), "other");
  StartedSweep narrowed(server.address(), "third");
  files_.Write("tokens",
               LineOf("lab", "fresh", "sweep") + LineOf("shop", "other", "sweep") + LineOf("office", "third", "solve"));
  EXPECT_EQ(removed.ReadFor(std::chrono::seconds(20)).code(), StatusCode::kUnauthenticated);
  EXPECT_EQ(narrowed.ReadFor(std::chrono::seconds(20)).code(), StatusCode::kUnauthenticated);
  EXPECT_TRUE(kept.ReadFor(std::chrono::seconds(2)).ok());
}

TEST_F(Tokens, CallersBehindOneAddressHavePlacesOfTheirOwn) {
  files_.Write("tokens", LineOf("lab", "secret", "sweep") + LineOf("shop", "other", "sweep"));
  const ServerProcess server({"--tokens", files_ / "tokens", "--max-streams-per-peer", "1"});
  const StartedSweep lab(server.address(), "secret");
  EXPECT_TRUE(lab.first.ok()) << lab.first;
  const StartedSweep second(server.address(), "secret");
  EXPECT_EQ(ReasonOf(second.first), ErrorReason::kTooManyCalls) << second.first;
  const StartedSweep shop(server.address(), "other");
  EXPECT_TRUE(shop.first.ok()) << shop.first;
}

TEST(OpenServer, SaysSoInItsLog) {
  const ServerProcess server({"--listen", "0.0.0.0:0", "--insecure"});
  EXPECT_THAT(server.log(), HasSubstr("warning open to other hosts"));
}

}  // namespace
}  // namespace ricochet
