// CallOptions: how the caller of a Solver ends a call before its answer is complete.
//
// A call that is ended early answers nothing but an error, a sweep nothing but an error after the chunks already sent.
// A LocalSolver looks at the options between pieces of work that take a few milliseconds at most. The reduction of a
// mechanism of n coordinates, or of a linkage of n links, is one piece: it takes 0.1 s for n = 1000, and 8 times as
// long for each doubling of n. Default options never end a call.

#ifndef RICOCHET_CALL_OPTIONS_H_
#define RICOCHET_CALL_OPTIONS_H_

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>

#include "ricochet/helpers.h"

namespace ricochet {

struct CallOptions {
  // Requesting a stop, from any thread, ends the call with CANCELLED.
  std::stop_token stop = {};
  // The call ends with DEADLINE_EXCEEDED once this time has passed. Absent: a LocalSolver has no deadline, and a Client
  // has that of its ClientOptions.
  std::optional<std::chrono::steady_clock::time_point> deadline = {};
  // This is for a caller who has no stop token but can be asked: the call ends with CANCELLED once it returns true. A
  // LocalSolver asks on the thread of the call; a Client asks before it sends the request and before each chunk of a
  // sweep. Empty: never asked.
  std::function<bool()> is_stopped = {};
  // These threads may help a sweep or a batch of a LocalSolver. Null stands for those of the solver. A Client does not
  // use them.
  std::shared_ptr<Helpers> helpers = {};
};

}  // namespace ricochet

#endif  // RICOCHET_CALL_OPTIONS_H_
