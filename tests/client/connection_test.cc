// How the client and the command line name a server and prove who they are.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "ricochet/client.h"
#include "ricochet/error.h"
#include "tests/client/cli_run.h"
#include "tests/support/server_process.h"
#include "tests/support/test_certificates.h"

namespace ricochet {
namespace {

using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;

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
  EXPECT_EQ(RunShell("RICOCHET_SERVER= RICOCHET_CONFIG=config \"$R\" health").out, "SERVING\n");
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
