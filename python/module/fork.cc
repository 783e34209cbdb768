#include "python/module/fork.h"

#include <grpc/fork.h>

#include <atomic>
#include <cstdlib>

#include "absl/status/status.h"
#include "python/module/raise.h"
#include "ricochet/engine_info.h"

namespace ricochet::python {
namespace {

// All but the first change with the lock of Python only.
std::atomic<int> calls_of_servers = 0;
bool uses_grpc = false;
bool was_calling = false;  // When the process was forked.
bool grpc_is_lost = false;

void BeforeFork() {
  // The child must not find this half made by another thread.
  ThisEngine();
  was_calling = calls_of_servers > 0;
  if (uses_grpc && !was_calling) grpc_prefork();
}

void AfterForkInParent() {
  if (uses_grpc && !was_calling) grpc_postfork_parent();
}

void AfterForkInChild() {
  calls_of_servers = 0;
  grpc_is_lost = grpc_is_lost || was_calling;
  if (uses_grpc && !was_calling) grpc_postfork_child();
}

}  // namespace

CallOfServer::CallOfServer(bool is_remote) : count_(is_remote ? 1 : 0) { calls_of_servers += count_; }
CallOfServer::~CallOfServer() { calls_of_servers -= count_; }

void StartGrpc() {
  if (grpc_is_lost) {
    Raise(absl::UnavailableError(
        "this process was forked while another thread asked a server: it cannot ask one, but compute itself"));
  }
  // gRPC reads this when it starts: whether it has handlers of a fork.
  if (!uses_grpc) setenv("GRPC_ENABLE_FORK_SUPPORT", "1", /*overwrite=*/0);
  uses_grpc = true;
}

void AddForks(pybind11::module_& module) {
  module.def("before_fork", &BeforeFork);
  module.def("after_fork_in_parent", &AfterForkInParent);
  module.def("after_fork_in_child", &AfterForkInChild);
}

}  // namespace ricochet::python
