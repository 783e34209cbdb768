// The log of a real ricochetd never stops it, whatever becomes of what the log is written to.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>

#include "proto/wire/status.h"
#include "ricochet/engine_info.h"
#include "ricochet/error.h"
#include "ricochet/info.h"
#include "tests/support/processes/server_process.h"
#include "tests/support/processes/service_calls.h"
#include "tests/support/processes/temporary_directory.h"

namespace ricochet {
namespace {

using std::chrono::seconds;
using std::chrono::steady_clock;
using testing::HasSubstr;
using testing::Not;

// Enough lines to fill a pipe of 64 KiB many times.
constexpr int kManyCalls = 2000;

std::string Contents(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// Waits until the file contains the text, at most 20 s, and returns what it contains.
std::string WaitForText(const std::filesystem::path& path, const std::string& text) {
  const auto end = steady_clock::now() + seconds(20);
  while (Contents(path).find(text) == std::string::npos && steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return Contents(path);
}

class ServerLog : public testing::Test {
 protected:
  std::filesystem::path Path(const std::string& name) const { return directory_.path() / name; }

  TemporaryDirectory directory_;
};

void ExpectManyAnswers(const ServerProcess& server) {
  const auto stub = MakeStub(server);
  for (int i = 0; i < kManyCalls; ++i) ASSERT_TRUE(Solve(*stub).ok()) << "call " << i;
}

TEST_F(ServerLog, TheFirstLineTellsWhichServerThisIsAndWhatItAllows) {
  const ServerProcess server({"--max-live-calls", "77"});
  const std::string first = server.log().substr(0, server.log().find('\n'));
  EXPECT_THAT(first, HasSubstr(" starting version=" + ThisEngine().version));
  EXPECT_THAT(first, HasSubstr("engine=" + ThisEngine().fingerprint));
  EXPECT_THAT(first, HasSubstr("listen=127.0.0.1:0"));
  EXPECT_THAT(first, HasSubstr("security=\"plaintext on this host\""));
  EXPECT_THAT(first, HasSubstr("max_live_calls=77"));
  for (const NamedServerLimit& limit : kServerLimits) {
    EXPECT_THAT(first, HasSubstr(" " + std::string(limit.name) + "=")) << limit.name;
  }
  for (const NamedLimit& limit : kLimits)
    EXPECT_THAT(first, HasSubstr(" " + std::string(limit.name) + "=")) << limit.name;
  EXPECT_THAT(first, HasSubstr(" max_unary_time_ms=60000 "));
}

TEST_F(ServerLog, APipeThatNobodyReadsStopsNeitherCallsNorTheDrain) {
  ASSERT_EQ(mkfifo(Path("pipe").c_str(), 0600), 0);
  const int pipe = open(Path("pipe").c_str(), O_RDWR | O_NONBLOCK);
  ServerProcess server({"--log-file", Path("pipe"), "--log-calls", "all"});
  ExpectManyAnswers(server);
  const auto before = steady_clock::now();
  EXPECT_EQ(server.Stop(), 0);
  EXPECT_LT(steady_clock::now() - before, seconds(10));
  close(pipe);
}

TEST_F(ServerLog, AFullDeviceStopsNeitherCallsNorTheDrain) {
  ServerProcess server({"--log-file", "/dev/full", "--log-calls", "all"});
  ExpectManyAnswers(server);
  EXPECT_EQ(server.Stop(), 0);
}

TEST_F(ServerLog, ARotatedFileIsReopenedAtSighup) {
  ServerProcess server({"--log-file", Path("log")});
  EXPECT_THAT(WaitForText(Path("log"), "listening"), HasSubstr("starting"));
  std::filesystem::rename(Path("log"), Path("log.1"));
  kill(server.pid(), SIGHUP);
  const auto end = steady_clock::now() + seconds(20);
  while (!std::filesystem::exists(Path("log")) && steady_clock::now() < end) std::this_thread::yield();
  ASSERT_TRUE(Solve(*MakeStub(server)).ok());
  const std::string text = WaitForText(Path("log"), "/Solve");
  EXPECT_THAT(text, HasSubstr("/Solve"));
  EXPECT_THAT(text, Not(HasSubstr("starting")));
  EXPECT_EQ(server.Stop(), 0);
  EXPECT_THAT(Contents(Path("log")), HasSubstr("stopped"));
}

TEST_F(ServerLog, AFileThatCannotBeOpenedIsAClearError) {
  const Ending ending = RunServerToEnd({"--listen", "127.0.0.1:0", "--log-file", Path("no/log")});
  EXPECT_EQ(ending.exit_status, 1);
  EXPECT_THAT(ending.output, HasSubstr(Path("no/log").string()));
}

TEST_F(ServerLog, TheRateOfCallsInTheLogIsBounded) {
  const ServerProcess server({"--log-calls", "rate:5"});
  const auto before = steady_clock::now();
  ExpectManyAnswers(server);
  const std::string log = server.log();
  // The server may write a line after the answer, but not after the log was read.
  const auto seconds_taken = std::chrono::ceil<seconds>(steady_clock::now() - before).count();
  int64_t lines = 0;
  for (size_t at = 0; (at = log.find("/Solve", at)) != std::string::npos; ++at) ++lines;
  EXPECT_GE(lines, 5);
  EXPECT_LE(lines, 5 * (seconds_taken + 1));
}

// Sends bytes to a method, and returns the status.
absl::Status SendBytes(const ServerProcess& server, const std::string& method, const std::string& bytes) {
  grpc::GenericStub stub(MakeChannel(server.address()));
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + seconds(20));
  grpc::CompletionQueue queue;
  const grpc::Slice slice(bytes);
  const auto call = stub.PrepareUnaryCall(&context, method, grpc::ByteBuffer(&slice, 1), &queue);
  call->StartCall();
  grpc::ByteBuffer answer;
  grpc::Status status;
  call->Finish(&answer, &status, nullptr);
  void* tag = nullptr;
  bool ok = false;
  queue.Next(&tag, &ok);
  return FromGrpcStatus(status);
}

TEST_F(ServerLog, BytesThatAreNoMessageAreRefusedWithAReasonAndLogged) {
  const ServerProcess server;
  const absl::Status status = SendBytes(server, "/ricochet.v1.ImpactService/Solve", "\xFF\xFF\xFF");
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(ReasonOf(status), ErrorReason::kInvalidRequest);
  EXPECT_THAT(server.WaitForLog("MALFORMED_REQUEST"), HasSubstr("reason=MALFORMED_REQUEST"));
}

TEST_F(ServerLog, AMethodThatThereIsNotIsLogged) {
  const ServerProcess server;
  EXPECT_EQ(SendBytes(server, "/ricochet.v1.ImpactService/Guess", "").code(), absl::StatusCode::kUnimplemented);
  EXPECT_THAT(server.WaitForLog("UNKNOWN_METHOD"), HasSubstr("status=UNIMPLEMENTED"));
}

TEST_F(ServerLog, ARequestThatAHandlerRefusesIsLoggedOnce) {
  const ServerProcess server;
  EXPECT_EQ(SendBytes(server, "/ricochet.v1.ImpactService/Solve", "").code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(SendBytes(server, "/ricochet.v1.ImpactService/Guess", "").code(), absl::StatusCode::kUnimplemented);
  const std::string log = server.WaitForLog("UNKNOWN_METHOD");
  EXPECT_EQ(log.find("INVALID_REQUEST"), log.rfind("INVALID_REQUEST"));
  EXPECT_THAT(log, HasSubstr("INVALID_REQUEST"));
}

// Returns what a descriptor of a process is, such as "/dev/null" or "socket:[123]".
std::string DescriptorOf(pid_t pid, const std::string& descriptor) {
  std::error_code closed;
  return std::filesystem::read_symlink("/proc/" + std::to_string(pid) + "/fd/" + descriptor, closed);
}

TEST_F(ServerLog, AServerWhoseStandardDescriptorsAreClosedHasNoLogAndServes) {
  const std::string command = "exec \"$0\" --listen 127.0.0.1:0 --drain-grace 0 --port-file \"$1\" <&- >&- 2>&-";
  ChildProcess server({"/bin/sh", "-c", command, RICOCHETD_PATH, Path("port")});
  const std::string port = WaitForText(Path("port"), "\n");
  const auto stub = v1::ImpactService::NewStub(MakeChannel("127.0.0.1:" + port.substr(0, port.find('\n'))));
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(Solve(*stub).ok());
  // gRPC takes some of the three numbers before main.
  for (const char* descriptor : {"0", "1", "2"}) {
    EXPECT_THAT(DescriptorOf(server.pid(), descriptor), testing::AnyOf("/dev/null", HasSubstr("anon_inode")));
  }
  int nowhere = 0;
  for (int i = 3; i < 20; ++i) nowhere += DescriptorOf(server.pid(), std::to_string(i)) == "/dev/null" ? 1 : 0;
  EXPECT_GE(nowhere, 1);
  server.Signal(SIGTERM);
  EXPECT_EQ(server.Wait(), 0);
}

}  // namespace
}  // namespace ricochet
