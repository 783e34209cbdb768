#include "client/channel.h"

#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <grpcpp/support/channel_arguments.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <thread>

#include "absl/synchronization/mutex.h"
#include "client/credentials.h"
#include "client/server_address.h"
#include "core/base/try.h"

namespace ricochet {
namespace {

// gRPC waits up to two minutes by default, and calls fail meanwhile although the server may be back. A name with
// several addresses, as localhost has, waits for each of them in turn.
constexpr int kFirstReconnectMs = 100;
constexpr int kLongestReconnectMs = 1'000;
constexpr int kKeepaliveTimeMs = 30'000;
constexpr int kKeepaliveTimeoutMs = 10'000;

// Packaged gRPC runs abseil's lock-order detector, which is slow and can abort on a false cycle, so it is turned off.
// After the last channel it destroys its event engine in a thread of that engine, which crashes in a process that ends
// meanwhile. A channel that never connects keeps the engine until then.
void SetUpOnce() {
  // The pointer is volatile, as a compiler may leave out one that is never read, and a leak checker would miss it.
  static const auto* volatile const kept = [] {
    absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
    return new auto(grpc::CreateChannel("unix:/", grpc::InsecureChannelCredentials()));
  }();
  static_cast<void>(kept);
}

// Counts the copies of an argument of every channel. Each part of a channel holds a copy and destroys it at its end,
// and a call keeps its channel alive.
std::atomic<int64_t> parts = 0;
void* Copied(void* counter) {
  ++parts;
  return counter;
}
void Destroyed(void* /*counter*/) { --parts; }
int Compared(void* /*one*/, void* /*other*/) { return 0; }
constexpr grpc_arg_pointer_vtable kPart = {.copy = Copied, .destroy = Destroyed, .cmp = Compared};

}  // namespace

absl::StatusOr<std::vector<std::shared_ptr<grpc::Channel>>> MakeChannels(const ClientOptions& options) {
  if (absl::Status status = ValidateOptions(options); !status.ok()) return status;
  SetUpOnce();
  grpc::ChannelArguments arguments;
  arguments.SetServiceConfigJSON(ServiceConfig(options));
  arguments.SetMaxReceiveMessageSize(static_cast<int>(options.max_receive_bytes));
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, kKeepaliveTimeMs);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, kKeepaliveTimeoutMs);
  if (!options.user_agent.empty()) arguments.SetUserAgentPrefix(options.user_agent);
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, kFirstReconnectMs);
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, kLongestReconnectMs);
  if (!options.security.server_name.empty()) arguments.SetSslTargetNameOverride(options.security.server_name);
  // gRPC would share the connection of another Client, which must end with that.
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  arguments.SetPointerWithVtable("ricochet.part", &parts, &kPart);
  std::vector<std::shared_ptr<grpc::Channel>> channels;
  for (const std::string& target : Targets(options)) {
    RICOCHET_TRY(const auto credentials, MakeChannelCredentials(options.security, target));
    grpc::ChannelArguments own = arguments;
    // A proxy of the environment would look for this address on its own host, and could read a token.
    if (IsLoopbackAddress(target)) own.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
    channels.push_back(grpc::CreateCustomChannel(target, credentials, own));
  }
  return channels;
}

void AwaitReconnection(grpc::Channel& channel, std::chrono::system_clock::time_point deadline) {
  constexpr std::chrono::milliseconds kLongest(250);
  if (channel.GetState(false) != GRPC_CHANNEL_TRANSIENT_FAILURE) return;
  channel.WaitForConnected(std::min(deadline, std::chrono::system_clock::now() + kLongest));
}

bool AllChannelsEnd(std::chrono::milliseconds longest) {
  const auto last = std::chrono::steady_clock::now() + longest;
  while (parts > 0) {
    if (std::chrono::steady_clock::now() > last) return false;
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
  return true;
}

}  // namespace ricochet
