// Calls of a real server by the generated stub, for tests: one connection a stub, one scene with a known answer.

#ifndef RICOCHET_TESTS_SUPPORT_PROCESSES_SERVICE_CALLS_H_
#define RICOCHET_TESTS_SUPPORT_PROCESSES_SERVICE_CALLS_H_

#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>
#include <grpcpp/support/sync_stream.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "ricochet/v1/impact_service.grpc.pb.h"
#include "tests/support/processes/server_process.h"

namespace ricochet {

// Points of a sweep that no test waits for.
inline constexpr int64_t kHuge = 8'000'000'000;

// Each channel has a connection of its own.
std::shared_ptr<grpc::Channel> MakeChannel(const std::string& address);
std::unique_ptr<v1::ImpactService::Stub> MakeStub(const ServerProcess& server);

// A pendulum with a = 0.3 m, b = 1 m, mu = 0.1 and an energetic coefficient of 1.
v1::Scene PaperScene();

// A sweep of PaperScene over its friction.
v1::SweepRequest SweepOf(int64_t points);

// Solves a scene with a deadline of 10 s.
absl::Status Solve(v1::ImpactService::Stub& stub, const v1::Scene& scene, v1::SolveResponse* response);
absl::Status Solve(v1::ImpactService::Stub& stub, const v1::Scene& scene = PaperScene());

// A sweep that a test reads chunk by chunk.
class RunningSweep {
 public:
  RunningSweep(v1::ImpactService::Stub& stub, const v1::SweepRequest& request,
               std::optional<std::chrono::milliseconds> deadline = std::nullopt);

  bool Read(v1::SweepResponse* chunk) { return reader_->Read(chunk); }
  void Cancel() { context_.TryCancel(); }

  // Reads all remaining chunks and returns the status.
  absl::Status Drain();

 private:
  grpc::ClientContext context_;
  std::unique_ptr<grpc::ClientReader<v1::SweepResponse>> reader_;
};

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_PROCESSES_SERVICE_CALLS_H_
