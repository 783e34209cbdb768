// MadeFrame: the parts of a small server that its calls share, for tests and benchmarks of handlers.

#ifndef RICOCHET_TESTS_SERVER_MADE_FRAME_H_
#define RICOCHET_TESTS_SERVER_MADE_FRAME_H_

#include <chrono>
#include <utility>

#include "server/calls/call.h"

namespace ricochet::server {

struct MadeFrame {
  explicit MadeFrame(const Observer& observer, DrainStops drain = {}, TimeLimits limits = {},
                     std::chrono::milliseconds unread_limit = std::chrono::seconds(30))
      : scheduler(2, 64, drain.streams),
        unread(unread_limit),
        frame{.live_calls = live_calls,
              .memory = memory,
              .scheduler = scheduler,
              .unread = unread,
              .drain = std::move(drain),
              .limits = limits,
              .observer = observer} {}

  LiveCalls live_calls{LiveCallLimitsFor(64)};
  CallMemory memory{int64_t{64} << 20};
  Scheduler scheduler;
  UnreadWatch unread;
  CallFrame frame;
};

}  // namespace ricochet::server

#endif  // RICOCHET_TESTS_SERVER_MADE_FRAME_H_
