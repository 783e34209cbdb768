#include "python/module/call.h"

namespace ricochet::python {

Call::Call(const Callee& callee) : callee_(callee), counted_(callee.is_remote) {
  if (callee_.deadline.has_value()) options_.deadline = Clock::now() + *callee_.deadline;
  if (callee_.is_remote) {
    options_.stop = stop_.get_token();
  } else {
    options_.is_stopped = [this] { return IsInterrupted(); };
  }
}

bool Call::IsInterrupted() {
  if (raised_.has_value()) return true;
  const Clock::time_point now = Clock::now();
  if (now < next_look_) return false;
  next_look_ = now + kBetweenLooks;
  const py::gil_scoped_acquire with_lock;
  return HandleSignals();
}

bool Call::HandleSignals() {
  if (PyErr_CheckSignals() == 0) return false;
  raised_.emplace();
  return true;
}

}  // namespace ricochet::python
