#include "python/module/call.h"

#include <grpc/fork.h>

#include <chrono>
#include <cstdlib>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "client/channel.h"
#include "ricochet/engine_info.h"

namespace ricochet::python {
namespace {

// These variables change only while the lock of Python is held.
int calls_of_servers = 0;
bool uses_grpc = false;
bool grpc_may_fork = false;  // gRPC's handlers run at this fork.
bool grpc_is_lost = false;

// Connections are closed before a fork, which waits at most this long until gRPC has destroyed them.
constexpr std::chrono::seconds kLongestClosing(2);

void BeforeFork() {
  // The child must not find this half made by another thread.
  ThisEngine();
  // gRPC's handler waits for its threads. One that destroys a call would wait for the handler in turn, for ever.
  grpc_may_fork = uses_grpc && calls_of_servers == 0 && AllChannelsEnd(kLongestClosing);
  if (grpc_may_fork) grpc_prefork();
}

void AfterForkInParent() {
  if (grpc_may_fork) grpc_postfork_parent();
}

void AfterForkInChild() {
  calls_of_servers = 0;
  grpc_is_lost = grpc_is_lost || (uses_grpc && !grpc_may_fork);
  if (grpc_may_fork) grpc_postfork_child();
}

}  // namespace

Call::Call(Callee callee) : callee_(std::move(callee)) {
  if (callee_.deadline.has_value()) options_.deadline = Clock::now() + *callee_.deadline;
  if (callee_.is_remote) {
    ++calls_of_servers;
    options_.stop = stop_.get_token();
  } else {
    options_.is_stopped = [this] { return IsInterrupted(); };
  }
}

Call::~Call() {
  if (callee_.is_remote) --calls_of_servers;
}

bool Call::IsInterrupted() {
  if (raised_.has_value()) return true;
  if (!IsTimeToLook()) return false;
  const WithLock with_lock;
  return HandleSignals();
}

bool Call::IsTimeToLook() {
  const Clock::time_point now = Clock::now();
  if (now < next_look_) return false;
  next_look_ = now + kBetweenLooks;
  return true;
}

bool Call::HandleSignals() {
  if (PyErr_CheckSignals() == 0) return false;
  raised_.emplace();
  return true;
}

void Callee::Abandon() {
  static auto* const kept = new std::vector<std::shared_ptr<const Solver>>();
  kept->push_back(std::move(solver));
}

void StartGrpc() {
  if (grpc_is_lost) {
    Raise(absl::UnavailableError(
        "this process was forked while another thread asked a server: it cannot ask one, but compute itself"));
  }
  // gRPC reads this when it starts: whether it has handlers of a fork.
  if (!uses_grpc) setenv("GRPC_ENABLE_FORK_SUPPORT", "1", /*overwrite=*/0);
  uses_grpc = true;
}

void AddForks(py::module_& module) {
  module.def("before_fork", &BeforeFork);
  module.def("after_fork_in_parent", &AfterForkInParent);
  module.def("after_fork_in_child", &AfterForkInChild);
}

}  // namespace ricochet::python
