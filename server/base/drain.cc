#include "server/base/drain.h"

namespace ricochet::server {
namespace {

using std::chrono::milliseconds;

// The time between two looks at the number of live calls.
constexpr milliseconds kPause(5);
// The time in which a unary call that is stopped ends; a solver notices a stop within some 10 ms.
constexpr milliseconds kTimeToStop(500);
// The time in which gRPC sends the last answers after their handlers have returned.
constexpr milliseconds kTimeToSend(100);

}  // namespace

void Drain::Run(const Signals& signals, const std::function<int()>& live_calls) {
  if (signals.WaitForStop(grace_)) return;
  streams_.request_stop();
  if (WaitForCalls(timeout_, signals, live_calls)) return;
  unary_.request_stop();
  if (WaitForCalls(kTimeToStop, signals, live_calls)) return;
  signals.WaitForStop(kTimeToSend);
}

bool Drain::WaitForCalls(milliseconds time, const Signals& signals, const std::function<int()>& live_calls) {
  const auto end = std::chrono::steady_clock::now() + time;
  while (live_calls() > 0 && std::chrono::steady_clock::now() < end) {
    if (signals.WaitForStop(kPause)) return true;
  }
  return false;
}

}  // namespace ricochet::server
