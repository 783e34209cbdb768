// Connections of a real ricochetd: addresses, limits, descriptors, compression, reflection apart.

#include <gmock/gmock.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/processes/eventually.h"
#include "tests/support/processes/server_process.h"
#include "tests/support/processes/service_calls.h"
#include "tests/support/processes/temporary_directory.h"

namespace ricochet {
namespace {

using std::chrono::seconds;
using testing::HasSubstr;

// A connection that says nothing.
class RawConnection {
 public:
  explicit RawConnection(int port) : socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    const sockaddr_in to = {.sin_family = AF_INET,
                            .sin_port = htons(static_cast<uint16_t>(port)),
                            .sin_addr = {htonl(INADDR_LOOPBACK)},
                            .sin_zero = {}};
    EXPECT_EQ(connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof(to)), 0);
  }
  ~RawConnection() {
    if (socket_ >= 0) close(socket_);
  }
  RawConnection(RawConnection&& other) noexcept : socket_(std::exchange(other.socket_, -1)) {}
  RawConnection& operator=(RawConnection&&) = delete;

  // True if the server has said something, as gRPC does at once, and not if it has closed the connection.
  bool IsServed() const {
    pollfd readable = {.fd = socket_, .events = POLLIN, .revents = 0};
    char byte = 0;
    return poll(&readable, 1, 10'000) == 1 && recv(socket_, &byte, 1, 0) == 1;
  }

 private:
  int socket_;
};

int64_t OpenDescriptors(const ServerProcess& server) {
  const std::filesystem::directory_iterator all("/proc/" + std::to_string(server.pid()) + "/fd");
  return std::distance(begin(all), end(all));
}

bool Solves(const std::string& target) { return Solve(*v1::ImpactService::NewStub(MakeChannel(target))).ok(); }

TEST(Connections, UnixSocketServesBesideTcpAndIsRemoved) {
  const TemporaryDirectory directory;
  const std::string target = "unix:" + directory / "ricochet.sock";
  ServerProcess server({"--listen", "127.0.0.1:0," + target, "--socket-mode", "640"});
  EXPECT_TRUE(Solves(server.address()));
  EXPECT_TRUE(Solves(target));
  struct stat file = {};
  ASSERT_EQ(lstat((directory / "ricochet.sock").c_str(), &file), 0);
  EXPECT_EQ(file.st_mode & 07777U, 0640U);
  EXPECT_EQ(server.Stop(), 0);
  EXPECT_FALSE(std::filesystem::exists(directory / "ricochet.sock"));
}

TEST(Connections, KilledServerIsReplacedOnItsUnixSocket) {
  const TemporaryDirectory directory;
  const std::string target = "unix:" + directory / "ricochet.sock";
  {
    const ServerProcess killed({"--listen", "127.0.0.1:0," + target});
    kill(killed.pid(), SIGKILL);
  }
  const ServerProcess server({"--listen", "127.0.0.1:0," + target});
  EXPECT_TRUE(Solves(target));
}

TEST(Connections, DescriptorsComeBack) {
  const ServerProcess server;
  ASSERT_TRUE(Solves(server.address()));
  const int64_t before = OpenDescriptors(server);
  for (int round = 0; round < 3; ++round) {
    std::vector<RawConnection> connections;
    for (int i = 0; i < 100; ++i) connections.emplace_back(server.port());
    for (const RawConnection& connection : connections) ASSERT_TRUE(connection.IsServed());
    // The connection of the first call, which takes two, may have ended in between.
    EXPECT_GE(OpenDescriptors(server), before + 200 - 2);
  }
  EXPECT_TRUE(Eventually([&] { return OpenDescriptors(server) <= before; })) << OpenDescriptors(server);
}

TEST(Connections, AboveTheLimitAreClosedUntilOneEnds) {
  const ServerProcess server({"--max-connections", "2"});
  std::vector<RawConnection> connections;
  for (int i = 0; i < 2; ++i) connections.emplace_back(server.port());
  for (const RawConnection& connection : connections) ASSERT_TRUE(connection.IsServed());
  EXPECT_FALSE(RawConnection(server.port()).IsServed());
  EXPECT_THAT(server.WaitForLog("connections refused"), HasSubstr("last_reason=\"too many connections\""));
  connections.clear();
  EXPECT_TRUE(Eventually([&] { return Solves(server.address()); }));
}

TEST(Connections, ServerOutOfDescriptorsServesAgain) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer checks virtual tables through a pipe, and ends a process that can open none";
#endif
  const ServerProcess server;
  const rlimit few = {.rlim_cur = static_cast<rlim_t>(OpenDescriptors(server) + 20), .rlim_max = 4096};
  ASSERT_EQ(prlimit(server.pid(), RLIMIT_NOFILE, &few, nullptr), 0);
  {
    std::vector<RawConnection> burst;
    for (int i = 0; i < 100; ++i) burst.emplace_back(server.port());
    EXPECT_THAT(server.WaitForLog("Too many open files"), HasSubstr("connections refused"));
  }
  EXPECT_TRUE(Eventually([&] { return Solves(server.address()); }));
}

TEST(Connections, FewDescriptorsMeanFewConnectionsFromTheStart) {
  const TemporaryDirectory directory;
  const std::string port_file = directory / "port";
  ChildProcess server({"/bin/sh", "-c", "ulimit -n 64; exec \"$0\" \"$@\"", ServerPath(), "--listen", "127.0.0.1:0",
                       "--port-file", port_file});
  ASSERT_TRUE(Eventually([&] { return std::filesystem::exists(port_file); })) << server.output();
  EXPECT_THAT(server.output(), HasSubstr("fewer connections than asked for descriptors=64 max_connections=16"));
}

TEST(Connections, SoftLimitOfDescriptorsIsRaised) {
  const TemporaryDirectory directory;
  const std::string port_file = directory / "port";
  ChildProcess server({"/bin/sh", "-c", "ulimit -Sn 64; exec \"$0\" \"$@\"", ServerPath(), "--listen", "127.0.0.1:0",
                       "--port-file", port_file});
  ASSERT_TRUE(Eventually([&] { return std::filesystem::exists(port_file); })) << server.output();
  rlimit limit = {};
  ASSERT_EQ(prlimit(server.pid(), RLIMIT_NOFILE, nullptr, &limit), 0);
  EXPECT_EQ(limit.rlim_cur, limit.rlim_max);
  EXPECT_GT(limit.rlim_cur, 64U);
}

TEST(Connections, CompressedMessageIsRefusedUnread) {
  const ServerProcess server;
  const auto stub = MakeStub(server);
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + seconds(10));
  context.set_compression_algorithm(GRPC_COMPRESS_GZIP);
  v1::SolveRequest request;
  *request.mutable_scene() = PaperScene();
  // gRPC compresses only what becomes smaller.
  for (int i = 0; i < 1000; ++i) request.add_required(v1::EFFECT_FRICTION);
  v1::SolveResponse response;
  EXPECT_EQ(stub->Solve(&context, request, &response).error_code(), grpc::StatusCode::UNIMPLEMENTED);
}

// A reflection stream; its call ends with this object.
class ReflectionStream {
 public:
  explicit ReflectionStream(const std::string& target) : stub_(MakeChannel(target)) {
    context_.set_deadline(std::chrono::system_clock::now() + seconds(10));
    call_ = stub_.PrepareCall(&context_, "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo", &queue_);
    call_->StartCall(nullptr);
    Wait();
  }
  ~ReflectionStream() {
    context_.TryCancel();
    Finish();
  }
  ReflectionStream(const ReflectionStream&) = delete;
  ReflectionStream& operator=(const ReflectionStream&) = delete;

  // Returns the answer to a request for the list of services, as bytes, or nothing if the call has ended.
  std::string ListServices() {
    // These are the bytes of ServerReflectionRequest {list_services: "*"}, as Debian ships no generated code for it.
    grpc::Slice request("\x3a\x01*");
    call_->Write(grpc::ByteBuffer(&request, 1), nullptr);
    if (!Wait()) return "";
    grpc::ByteBuffer response;
    call_->Read(&response, nullptr);
    grpc::Slice answer;
    if (!Wait() || !response.DumpToSingleSlice(&answer).ok()) return "";
    return {reinterpret_cast<const char*>(answer.begin()), answer.size()};
  }

  grpc::StatusCode Finish() {
    if (!finished_) {
      call_->Finish(&status_, nullptr);
      finished_ = Wait();
    }
    return status_.error_code();
  }

 private:
  bool Wait() {
    void* tag = nullptr;
    bool ok = false;
    return queue_.Next(&tag, &ok) && ok;
  }

  grpc::GenericStub stub_;
  grpc::ClientContext context_;
  grpc::CompletionQueue queue_;
  std::unique_ptr<grpc::GenericClientAsyncReaderWriter> call_;
  grpc::Status status_;
  bool finished_ = false;
};

TEST(Reflection, ListsTheServiceAtAnAddressOfItsOwn) {
  const ServerProcess server({"--reflection", "127.0.0.1:0"});
  ReflectionStream stream(server.LoggedAddress("reflection"));
  const std::string services = stream.ListServices();
  EXPECT_THAT(services, HasSubstr("ricochet.v1.ImpactService"));
  EXPECT_THAT(services, HasSubstr("grpc.health.v1.Health"));
  EXPECT_FALSE(Solves(server.LoggedAddress("reflection")));
}

TEST(Reflection, IsNotServedBesideTheCalls) {
  const ServerProcess server({"--reflection", "127.0.0.1:0"});
  ReflectionStream stream(server.address());
  EXPECT_EQ(stream.ListServices(), "");
  EXPECT_EQ(stream.Finish(), grpc::StatusCode::UNIMPLEMENTED);
}

TEST(Reflection, IdleStreamsTakeNothingFromTheCalls) {
  const ServerProcess server({"--reflection", "127.0.0.1:0", "--max-live-calls", "2"});
  const std::string target = server.LoggedAddress("reflection");
  std::vector<std::unique_ptr<ReflectionStream>> idle;
  for (int i = 0; i < 30; ++i) idle.push_back(std::make_unique<ReflectionStream>(target));
  EXPECT_TRUE(Solves(server.address()));
}

}  // namespace
}  // namespace ricochet
