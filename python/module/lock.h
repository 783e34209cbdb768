// WithoutLock: lets other threads of Python go on while it lives. WithLock: holds the lock of Python while it lives.
//
// Once Python shuts down it ends threads that ask for its lock by unwinding their stacks. Destructors on the way would
// need that lock, so that such a thread stays where it is until the process ends.

#ifndef RICOCHET_PYTHON_MODULE_LOCK_H_
#define RICOCHET_PYTHON_MODULE_LOCK_H_

#include <cxxabi.h>
#include <pybind11/pybind11.h>
#include <unistd.h>

#include <optional>

namespace ricochet::python {

template <typename Take>
void TakeLock(Take take) {
  try {
    take();
  } catch (abi::__forced_unwind&) {
    for (;;) pause();
  }
}

class WithoutLock {
 public:
  WithoutLock() : state_(PyEval_SaveThread()) {}
  ~WithoutLock() {
    TakeLock([this] { PyEval_RestoreThread(state_); });
  }
  WithoutLock(const WithoutLock&) = delete;
  WithoutLock& operator=(const WithoutLock&) = delete;

 private:
  PyThreadState* const state_;
};

class WithLock {
 public:
  WithLock() {
    TakeLock([this] { lock_.emplace(); });
  }

 private:
  std::optional<pybind11::gil_scoped_acquire> lock_;
};

}  // namespace ricochet::python

#endif  // RICOCHET_PYTHON_MODULE_LOCK_H_
