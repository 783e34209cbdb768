// Tests how the client and the command line name a server and prove who they are.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/channel.h"
#include "ricochet/client.h"
#include "ricochet/error.h"
#include "tests/client/cli/cli_run.h"
#include "tests/support/processes/eventually.h"
#include "tests/support/processes/server_process.h"
#include "tests/support/processes/test_certificates.h"

namespace ricochet {
namespace {

using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::vector<Violation> ViolationsOf(const std::string& target, const SecurityOptions& security) {
  return ricochet::ViolationsOf(Client::Connect({.target = target, .security = security}).status());
}

TEST(SecurityOptions, TokenIsNotSentUnencryptedBeyondThisHost) {
  const SecurityOptions bearing = {.token = "secret"};
  for (const char* target : {"127.0.0.1:1", "127.9.9.9:1", "localhost:1", "[::1]:1", "dns:///localhost:1",
                             "ipv4:127.0.0.1:1,127.0.0.2:1", "unix:/run/ricochet.sock", "unix-abstract:ricochet"}) {
    EXPECT_THAT(ViolationsOf(target, bearing), IsEmpty()) << target;
  }
  for (const char* target :
       {"192.0.2.1:1", "host:1", "localhost.example:1", "127.0.0.1.example:1", "127.example:1", "[::2]:1",
        "dns:///host:1", "ipv4:127.0.0.1:1,192.0.2.1:1", "unix:/run/ricochet.sock,host:1"}) {
    EXPECT_THAT(ViolationsOf(target, bearing), ElementsAre(Field(&Violation::field, "security.token"))) << target;
    EXPECT_THAT(ViolationsOf(target, {.tls = true, .token = "secret"}), IsEmpty()) << target;
  }
}

TEST(Channels, AreGoneWithAllTheirCallsSoonAfterTheLastPointer) {
  const ServerProcess server;
  const auto calls = [&] {
    const absl::StatusOr<Client> client = Client::Connect({.target = server.address()});
    for (int i = 0; i < 20; ++i) EXPECT_TRUE(client->Info().ok());
    EXPECT_FALSE(AllChannelsEnd(std::chrono::milliseconds(10)));
  };
  for (int i = 0; i < 20; ++i) {
    calls();
    EXPECT_TRUE(AllChannelsEnd(std::chrono::seconds(20)));
  }
}

TEST(SecurityOptions, AreRefusedByName) {
  EXPECT_THAT(ViolationsOf("host:1", {.tls = true, .tls_cert = "c"}),
              ElementsAre(Field(&Violation::field, "security.tls_key")));
  EXPECT_THAT(ViolationsOf("host:1", {.tls_ca = "a", .server_name = "n"}),
              ElementsAre(Violation{"security.tls_ca", "= a: needs security.tls"},
                          Violation{"security.server_name", "= n: needs security.tls"}));
  EXPECT_THAT(ViolationsOf("localhost:1", {.token = "a b"}),
              ElementsAre(Violation{"security.token", "is set: must have visible ASCII characters only"}));
  EXPECT_THAT(ViolationsOf("localhost:1", {.token = "a", .token_file = "f"}),
              ElementsAre(Field(&Violation::field, "security.token")));
  EXPECT_THAT(
      ViolationsOf("host:1", {.tls = true, .tls_ca = "/nonexistent"}),
      ElementsAre(Violation{"security.tls_ca", "= /nonexistent: must be a file that can be read and is not empty"}));
}

using cli::Arguments;
using cli::CliResult;
using cli::CliTest;

using Connection = CliTest;

TEST_F(Connection, FlagComesBeforeEnvironmentBeforeFile) {
  const ServerProcess server;
  Write("config", "server = \"127.0.0.1:1\"\ndeadline = \"never\"\n");
  const std::string run = "\"$R\" health --config config ";
  const std::string env = "RICOCHET_DEADLINE=5s RICOCHET_SERVER=";
  EXPECT_EQ(RunShell(env + "127.0.0.1:1 " + run + "--server " + server.address()).out, "SERVING\n");
  EXPECT_EQ(RunShell(env + server.address() + " " + run).out, "SERVING\n");
  EXPECT_THAT(RunShell(run).err, HasSubstr("--deadline = never"));
  Write("config", "server = \"" + server.address() + "\"\n");
  EXPECT_EQ(RunShell(run).out, "SERVING\n");
  EXPECT_EQ(RunShell("RICOCHET_CONFIG=config \"$R\" health").out, "SERVING\n");
}

// No host has 192.0.2.1, which is reserved for documentation, so that only a proxy could answer for it.
TEST_F(Connection, ProxyOfTheEnvironmentIsNotAskedForThisHost) {
  const ServerProcess server;
  const std::string port = server.address().substr(server.address().rfind(':'));
  const std::string run = "http_proxy=http://127.0.0.1:1 \"$R\" health --deadline 5s --server ";
  for (const char* const host : {"127.0.0.1", "localhost", "dns:///localhost"}) {
    EXPECT_EQ(RunShell(run + host + port).out, "SERVING\n") << host;
  }
  EXPECT_THAT(RunShell(run + "192.0.2.1:50051").err, HasSubstr("127.0.0.1:1: "));
}

// An empty variable may stand for a protection that is wanted: with RICOCHET_TLS_CA= nothing would be encrypted.
TEST_F(Connection, AnEmptySettingIsRefusedWhereverItStands) {
  for (const char* const name : {"CONFIG", "SERVER", "DEADLINE", "TLS", "TLS_CA", "TLS_CERT", "TLS_KEY", "SERVER_NAME",
                                 "TOKEN_FILE", "TOKEN", "MAX_RECEIVE"}) {
    const CliResult result = RunShell(absl::StrCat("RICOCHET_", name, "= \"$R\" info"));
    EXPECT_EQ(result.exit_code, 2) << name;
    EXPECT_THAT(result.err, HasSubstr(absl::StrCat("RICOCHET_", name, " is empty: must have a value, or not be set")));
  }
  Write("config", "server = \"127.0.0.1:1\"\ntls-ca = \"\"\n");
  EXPECT_THAT(Run({"info", "--config", "config"}).err, HasSubstr("--config = config: tls-ca is empty: must have"));
  Write("config", "[client]\nserver = \"127.0.0.1:1\"\n");
  EXPECT_THAT(Run({"info", "--config", "config"}).err, HasSubstr("[client]: the file must have no sections"));
}

TEST_F(Connection, UnknownLineOfTheFileIsRefused) {
  Write("config", "server = \"127.0.0.1:1\"\nspeed = 1\n");
  const CliResult result = Run({"health", "--config", "config"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("--config = config: speed must be one of server, deadline, tls"));
  EXPECT_EQ(Run({"health", "--config", "missing"}).exit_code, 2);
}

TEST_F(Connection, FlagThatNeedsAServerIsRefusedWithoutOne) {
  const Arguments solve = {"solve", "--a", "0.3", "--b", "1", "--energetic", "1"};
  for (const char* flag :
       {"--tls-ca", "--tls-cert", "--tls-key", "--server-name", "--token-file", "--deadline", "--max-receive"}) {
    Arguments arguments = solve;
    arguments.insert(arguments.end(), {flag, "x"});
    const CliResult result = Run(arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr(std::string(flag) + " needs --server"));
  }
  // A setting for all commands of a shell does no harm to those that compute here.
  EXPECT_EQ(RunShell("RICOCHET_TLS_CA=x \"$R\" solve --a 0.3 --b 1 --energetic 1 -o /dev/null").exit_code, 0);
}

// A real server with TLS that wants certificates of its clients, one with TLS alone, and one without, with the files
// that clients may show them.
class ExitCodes : public CliTest {
 protected:
  ExitCodes() {
    files_.MakeAuthority("other");
    files_.Make("server", "ricochet.test");
    files_.Make("ended", "ricochet.test", "ca", -1);
    files_.Make("client", "lab.test");
    files_.Make("old", "lab.test", "ca", -1);
    files_.Make("stranger", "lab.test", "other");
    files_.Write("garbage.pem", "-----BEGIN CERTIFICATE-----\nAAAA\n");
    files_.Write("empty", "");
    files_.Write("blank", " \n");
    files_.Write("two words", "secret secret\n");
  }

  // Returns what `ricochet solve` says of the server with these flags.
  CliResult Solve(const std::string& server, const Arguments& flags) const {
    Arguments all = {"solve", "--a", "0.3", "--b", "1", "--energetic", "1", "--server", server};
    all.insert(all.end(), flags.begin(), flags.end());
    return Run(all);
  }

  TestCertificates files_;
};

struct Failure {
  std::string server;
  Arguments flags;
  int exit_code;
  std::string message;
};

TEST_F(ExitCodes, TryAgainIsSaidOnlyOfWhatARetryCanMend) {
  const ServerProcess tls({"--tls-cert", files_ / "server.pem", "--tls-key", files_ / "server.key"});
  const ServerProcess mutual(
      {"--tls-cert", files_ / "server.pem", "--tls-key", files_ / "server.key", "--tls-client-ca", files_ / "ca.pem"});
  const ServerProcess plain;
  const std::string ca = files_ / "ca.pem";
  const Arguments trusting = {"--tls-ca", ca, "--server-name", "ricochet.test"};
  const auto showing = [&](const std::string& certificate, const std::string& key) {
    return Arguments{"--tls-ca",           ca,          "--server-name", "ricochet.test", "--tls-cert",
                     files_ / certificate, "--tls-key", files_ / key};
  };
  const Failure failures[] = {
      // The request is wrong: its files, its address.
      {tls.address(), {"--tls-ca", "nosuch"}, 2, "--tls-ca: security.tls_ca = nosuch: must be a file"},
      {tls.address(), {"--tls-ca", files_ / "empty"}, 2, "must be a file that can be read and is not empty"},
      {tls.address(), {"--tls-ca", files_ / "garbage.pem"}, 2, "garbage.pem: must hold a certificate in PEM form"},
      {tls.address(), showing("garbage.pem", "client.key"), 2, "--tls-cert: security.tls_cert = "},
      {tls.address(), showing("old.pem", "old.key"), 2, "must hold a certificate whose time has not ended"},
      {tls.address(), showing("client.pem", "nosuch"), 2, "--tls-key: security.tls_key = "},
      {tls.address(), showing("client.pem", "garbage.pem"), 2, "must hold a private key in PEM form"},
      {tls.address(), showing("client.pem", "stranger.key"), 2, "must hold the private key of security.tls_cert"},
      {plain.address(), {"--token-file", "nosuch"}, 2, "--token-file: security.token_file = nosuch: must be a file"},
      {plain.address(), {"--token-file", files_ / "blank"}, 2, "must hold a token of visible ASCII characters only"},
      {plain.address(), {"--token-file", files_ / "two words"}, 2, "must hold a token of visible ASCII characters"},
      {"http://127.0.0.1:5", {}, 2, "--server: target = \"http://127.0.0.1:5\": must be HOST:PORT or unix:PATH"},
      {"127.0.0.1:65536", {}, 2, "must have a port from 1 to 65535"},
      // The server is not the one that is meant, or refuses this client.
      {tls.address(), {"--tls-ca", files_ / "other.pem", "--server-name", "ricochet.test"}, 42, "is not trusted"},
      {tls.address(), {"--tls", "--server-name", "ricochet.test"}, 42, "is not trusted"},
      {tls.address(), {"--tls-ca", ca, "--server-name", "other.test"}, 42, "is for another name"},
      {tls.address(), {"--tls-ca", ca}, 42, "is for another name"},
      {plain.address(), trusting, 42, "the server does not speak TLS"},
      // The server may be there soon, or have room soon.
      {plain.address(), {"--max-receive", "100"}, 42, "(--max-receive) allows"},
      {"127.0.0.1:1", {}, 75, "UNAVAILABLE"},
      {"127.0.0.1:1", trusting, 75, "UNAVAILABLE"},
      {"unix:/nonexistent", {}, 75, "UNAVAILABLE"},
      {tls.address(), {}, 75, "it has no room, or it wants TLS (security.tls, --tls)"},
      // A server of gRPC does not say why it closes a connection.
      {mutual.address(), trusting, 75, "or another certificate of this client (security.tls_cert, --tls-cert)"},
      {mutual.address(), showing("stranger.pem", "stranger.key"), 75, "or another certificate of this client"},
      // Right options are accepted.
      {tls.address(), trusting, 0, ""},
      {mutual.address(), showing("client.pem", "client.key"), 0, ""},
      {plain.address(), {}, 0, ""},
  };
  for (const Failure& failure : failures) {
    const CliResult result = Solve(failure.server, failure.flags);
    EXPECT_EQ(result.exit_code, failure.exit_code) << testing::PrintToString(failure.flags) << result.err;
    EXPECT_THAT(result.err, HasSubstr(failure.message));
    EXPECT_THAT(result.err, Not(HasSubstr(".cc:"))) << "the log of gRPC";
  }
}

TEST_F(ExitCodes, ACertificateOfTheServerThatHasEndedIsNotToBeTriedAgain) {
  const ServerProcess server({"--tls-cert", files_ / "ended.pem", "--tls-key", files_ / "ended.key"});
  const CliResult result = Solve(server.address(), {"--tls-ca", files_ / "ca.pem", "--server-name", "ricochet.test"});
  EXPECT_EQ(result.exit_code, 42);
  EXPECT_THAT(result.err, HasSubstr("is not trusted"));
}

// Proxies say by an alert that they refuse a certificate, as the server of openssl does.
TEST_F(ExitCodes, ARefusalInWordsIsNotToBeTriedAgain) {
  const ChildProcess proxy({"/usr/bin/openssl", "s_server", "-accept", "127.0.0.1:0", "-alpn", "h2", "-cert",
                            files_ / "server.pem", "-key", files_ / "server.key", "-CAfile", files_ / "ca.pem",
                            "-Verify", "1", "-verify_return_error", "-www"});
  const std::string accept = "ACCEPT ";
  ASSERT_TRUE(Eventually([&] { return proxy.output().find(accept) != std::string::npos; })) << proxy.output();
  const std::string output = proxy.output();
  const size_t start = output.find(accept) + accept.size();
  const std::string address = output.substr(start, output.find('\n', start) - start);
  const Arguments trusting = {"--tls-ca", files_ / "ca.pem", "--server-name", "ricochet.test"};
  const CliResult without = Solve(address, trusting);
  EXPECT_EQ(without.exit_code, 42);
  EXPECT_THAT(without.err, HasSubstr("the server refuses this client: tlsv13 alert certificate required"));
  Arguments stranger = trusting;
  stranger.insert(stranger.end(), {"--tls-cert", files_ / "stranger.pem", "--tls-key", files_ / "stranger.key"});
  EXPECT_EQ(Solve(address, stranger).exit_code, 42);
  EXPECT_THAT(Solve(address, stranger).err, HasSubstr("the server refuses this client: tlsv1 alert unknown ca"));
}

TEST_F(ExitCodes, EveryKindOfCallIsToldTheSame) {
  const ServerProcess tls({"--tls-cert", files_ / "server.pem", "--tls-key", files_ / "server.key"});
  const std::string flags = " --server " + tls.address() + " --tls-ca " + files_ / "other.pem";
  const std::string scene = " --a 0.3 --b 1 --mu 0.1 --energetic 1";
  for (const std::string& command :
       {"solve" + scene, "bounds" + scene, "cost" + scene, "audit --observed-rate 0.1" + scene, std::string("info"),
        std::string("health"), "sweep --axis mu=lin:0:0.4:3" + scene, "solve --data -" + scene}) {
    const CliResult result = RunShell("\"$R\" " + command + flags, "mu\n0.1\n");
    EXPECT_EQ(result.exit_code, 42) << command << result.err;
    EXPECT_THAT(result.err, HasSubstr("the server's certificate is not trusted")) << command;
  }
}

TEST_F(ExitCodes, AnAnswerThatIsTooLargeIsNotToBeTriedAgain) {
  const ServerProcess server;
  const std::string flags = " --server " + server.address() + " --max-receive 100";
  const std::string scene = " --a 0.3 --b 1 --mu 0.1 --energetic 1";
  for (const std::string& command : {"cost" + scene, "sweep --axis mu=lin:0:0.4:300" + scene}) {
    const CliResult result = RunShell("\"$R\" " + command + flags);
    EXPECT_EQ(result.exit_code, 42) << command;
    EXPECT_THAT(result.err, HasSubstr("(--max-receive) allows"));
  }
}

TEST_F(ExitCodes, TheLogOfGrpcIsShownWhereItIsAskedFor) {
  const ServerProcess tls({"--tls-cert", files_ / "server.pem", "--tls-key", files_ / "server.key"});
  const CliResult result = RunShell("GRPC_VERBOSITY=ERROR \"$R\" health --tls --server " + tls.address());
  EXPECT_EQ(result.exit_code, 42);
  EXPECT_THAT(result.err, HasSubstr("ssl_transport_security.cc"));
}

TEST_F(Connection, EverySubcommandProvesWhoItIs) {
  TestCertificates files;
  files.Make("server", "ricochet.test");
  files.Make("client", "lab.test");
  // The hash is that of "abc".
  files.Write("tokens", "lab sha256:ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad all\n");
  files.Write("token", "abc\n");
  const ServerProcess server({"--tls-cert", files / "server.pem", "--tls-key", files / "server.key", "--tls-client-ca",
                              files / "ca.pem", "--tokens", files / "tokens"});
  const std::string environment = "export RICOCHET_SERVER=" + server.address() +
                                  " RICOCHET_TLS_CA=" + files / "ca.pem" +
                                  " RICOCHET_TLS_CERT=" + files / "client.pem" +
                                  " RICOCHET_TLS_KEY=" + files / "client.key" + " RICOCHET_SERVER_NAME=ricochet.test\n";
  const std::string scene = " --a 0.3 --b 1 --energetic 1";
  const std::string with_token = environment + "export RICOCHET_TOKEN_FILE=" + files / "token" + "\n";
  for (const std::string& command :
       {"solve" + scene, "bounds" + scene,
        "sweep" + scene + " --axis friction.kinetic_coefficient=lin:0:0.4:3 --column coefficients.newton"}) {
    const CliResult result = RunShell(with_token + "\"$R\" " + command);
    EXPECT_EQ(result.exit_code, 0) << command << result.err;
    EXPECT_NE(RunShell(environment + "\"$R\" " + command).exit_code, 0);
  }
  EXPECT_EQ(RunShell(environment + "\"$R\" health").out, "SERVING\n");
  EXPECT_EQ(RunShell(environment + "export RICOCHET_TOKEN=abc\n\"$R\" solve" + scene).exit_code, 0);
}

}  // namespace
}  // namespace ricochet
