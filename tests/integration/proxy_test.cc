// The recipe of deploy/haproxy.cfg: a real HAProxy before a real ricochetd.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <sstream>
#include <string>

#include "ricochet/client.h"
#include "tests/support/paths.h"
#include "tests/support/processes/eventually.h"
#include "tests/support/processes/server_process.h"
#include "tests/support/processes/test_certificates.h"

namespace ricochet {
namespace {

using std::chrono::seconds;

constexpr char kHost[] = "ricochet.test";

std::string ReadFile(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

class Proxy : public testing::Test {
 protected:
  Proxy() {
    files_.Make("server", kHost);
    files_.Make("client", "lab.test");
    files_.Write("both.pem", ReadFile(files_ / "server.pem") + ReadFile(files_ / "server.key"));
  }

  // Solves through the proxy by a new client.
  absl::Status Solve(const SecurityOptions& security) const {
    Scene scene;
    scene.system = Pendulum{.inertia_kg_m2 = 1.0, .a_m = 0.3, .b_m = 1.0, .omega_minus_rad_s = -1.0};
    scene.restitution = EnergeticCoefficient{1.0};
    const auto client = Client::Connect(
        {.target = target_, .deadline = seconds(10), .retry = {.max_attempts = 1}, .security = security});
    return client.ok() ? client->Solve({.scene = scene}).status() : client.status();
  }

  TestCertificates files_;
  const std::string target_ = "unix:" + files_ / "proxy.sock";
  const SecurityOptions without_certificate_ = {.tls = true, .tls_ca = files_ / "ca.pem", .server_name = kHost};
  const SecurityOptions with_certificate_ = {.tls = true,
                                             .tls_ca = files_ / "ca.pem",
                                             .tls_cert = files_ / "client.pem",
                                             .tls_key = files_ / "client.key",
                                             .server_name = kHost};
};

TEST_F(Proxy, PassesCallsOfClientsWithACertificate) {
  const ServerProcess server({"--listen", "127.0.0.1:0,unix:" + files_ / "server.sock"});
  ChildProcess haproxy({"/usr/bin/env", "RICOCHET_BIND=unix@" + files_ / "proxy.sock",
                        "RICOCHET_TLS=" + files_ / "both.pem", "RICOCHET_CLIENT_CA=" + files_ / "ca.pem",
                        "RICOCHET_SOCKET=" + files_ / "server.sock", "/usr/sbin/haproxy", "-db", "-f",
                        SourceRoot() + "/deploy/haproxy.cfg"});
  ASSERT_TRUE(Eventually([&] { return !haproxy.running() || Solve(with_certificate_).ok(); }));
  EXPECT_TRUE(haproxy.running()) << haproxy.output();
  EXPECT_TRUE(Solve(with_certificate_).ok()) << Solve(with_certificate_) << haproxy.output();
  EXPECT_EQ(Solve(without_certificate_).code(), absl::StatusCode::kUnavailable);
}

}  // namespace
}  // namespace ricochet
