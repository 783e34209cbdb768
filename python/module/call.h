// Call: one call of a Solver by a thread of Python.
//
// The call runs without the lock of Python, so that other threads go on. Every 20 ms it lets Python handle the signals
// that have arrived; an exception of a handler, such as the KeyboardInterrupt of Ctrl-C, ends the call and is raised in
// place of its answer. A LocalSolver is asked on the thread of the call, where it looks at its options every few
// milliseconds. A Client waits for the network without looking, so that it is asked on another thread, which is told to
// stop.
//
// A process that is forked has no thread but the one that forked. So the child leaves every solver as it is for ever
// and makes others. gRPC has handlers of its own for a fork, which need that no call is under way, not even one that
// gRPC is about to destroy: connections are closed before a fork, and opened again by the next call. A child that was
// forked while another thread asked a server can compute, but not ask a server.

#ifndef RICOCHET_PYTHON_MODULE_CALL_H_
#define RICOCHET_PYTHON_MODULE_CALL_H_

#include <pybind11/pybind11.h>

#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <stop_token>
#include <utility>

#include "python/module/exceptions.h"
#include "python/module/lock.h"
#include "ricochet/solver.h"

namespace ricochet::python {

// Callee holds the solver that a client of Python asks, and says how its calls end.
struct Callee {
  std::shared_ptr<const Solver> solver;
  bool is_remote = false;
  std::optional<std::chrono::milliseconds> deadline;  // Each call has it; absent if the solver has its own.

  // Leaves the solver as it is for ever: after a fork its threads and connections are those of the parent.
  void Abandon();
};

// Says that gRPC is about to be used, so that forks need its handlers. Raises Unavailable in a child that cannot use
// it.
void StartGrpc();

// Adds to the module what os.register_at_fork takes.
void AddForks(py::module_& module);

class Call {
 public:
  explicit Call(Callee callee);
  ~Call();
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  const Solver& solver() const { return *callee_.solver; }
  // The options of what `compute` asks the solver for. They must not outlive this object.
  const CallOptions& options() const { return options_; }

  // Returns what `compute` returns. It is called without the lock of Python, once for a call with one answer and once
  // for each part of a stream.
  template <typename Compute>
  auto Run(Compute compute) {
    auto result = callee_.is_remote ? RunBeside(compute) : RunHere(compute);
    if (raised_.has_value()) throw py::error_already_set(*raised_);
    return result;
  }

  // Returns the answer of `method`. Raises the exception for an error.
  template <typename Request, typename Method>
  auto Ask(Method method, const Request& request) {
    auto answer = Run([&] { return std::invoke(method, solver(), request, options_); });
    if (!answer.ok()) Raise(answer.status());
    return *std::move(answer);
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kBetweenLooks{20};

  template <typename Compute>
  auto RunHere(Compute& compute) {
    const WithoutLock without_lock;
    return compute();
  }

  template <typename Compute>
  auto RunBeside(Compute& compute) {
    auto answer = std::async(std::launch::async, [&compute] { return compute(); });
    for (;;) {
      bool is_ready = false;
      {
        const WithoutLock without_lock;
        is_ready = answer.wait_for(kBetweenLooks) == std::future_status::ready;
      }
      // Parts of a stream may all be ready at once, so that signals are handled here, too.
      if (!raised_.has_value() && IsTimeToLook() && HandleSignals()) stop_.request_stop();
      if (is_ready) return answer.get();
    }
  }

  // A LocalSolver asks this on the thread of the call.
  bool IsInterrupted();
  // Returns true once each 20 ms.
  bool IsTimeToLook();
  // Lets Python handle signals, on its main thread alone. Returns true if that has raised an exception.
  bool HandleSignals();

  const Callee callee_;
  CallOptions options_;
  std::stop_source stop_;
  Clock::time_point next_look_ = Clock::now() + kBetweenLooks;
  std::optional<py::error_already_set> raised_;
};

// Calls take(part) for every part of the stream that `method` answers with. Raises the exception for an error.
template <typename Stream, typename Method, typename Request, typename Take>
void ForEachPart(Call& call, Method method, const Request& request, Take take) {
  std::optional<Stream> stream;
  typename Stream::Iterator part;
  const auto go_on = [&] {
    if (stream.has_value()) {
      ++part;
    } else {
      stream.emplace(std::invoke(method, call.solver(), request, call.options()));
      part = stream->begin();
    }
    return part != stream->end();
  };
  while (call.Run(go_on)) {
    if (!part->ok()) Raise(part->status());
    take(**part);
  }
}

}  // namespace ricochet::python

#endif  // RICOCHET_PYTHON_MODULE_CALL_H_
