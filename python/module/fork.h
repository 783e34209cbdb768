// Forks of a process that uses the package.
//
// A child has no thread but the one that forked. So it leaves every solver as it is for ever (BoundSolver::Abandon) and
// makes others. gRPC has handlers of its own for a fork, which need that no call is under way: a child that was forked
// while another thread asked a server can compute, but not ask a server.

#ifndef RICOCHET_PYTHON_MODULE_FORK_H_
#define RICOCHET_PYTHON_MODULE_FORK_H_

#include <pybind11/pybind11.h>

namespace ricochet::python {

// Counts a call of a server while it lives.
class CallOfServer {
 public:
  explicit CallOfServer(bool is_remote);
  ~CallOfServer();
  CallOfServer(const CallOfServer&) = delete;
  CallOfServer& operator=(const CallOfServer&) = delete;

 private:
  const int count_;
};

// Says that gRPC is about to be used, so that forks need its handlers. Raises Unavailable in a child that cannot use it.
void StartGrpc();

// Adds the functions that os.register_at_fork takes to the module.
void AddForks(pybind11::module_& module);

}  // namespace ricochet::python

#endif  // RICOCHET_PYTHON_MODULE_FORK_H_
