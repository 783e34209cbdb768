#include "server/admission/live_calls.h"

#include "server/base/refusals.h"

namespace ricochet::server {
namespace {

constexpr char kCalls[] = "live calls";
constexpr char kStreams[] = "streams";

}  // namespace

absl::StatusOr<LiveCalls::Permit> LiveCalls::Enter(const std::string& peer, bool is_stream) {
  const std::lock_guard lock(mutex_);
  const auto found = peers_.find(peer);
  const Count of_peer = found == peers_.end() ? Count() : found->second;
  if (all_.calls >= limits_.calls) return TooManyCalls(kCalls, limits_.calls);
  if (of_peer.calls >= limits_.calls_per_peer) return TooManyCallsOfPeer(kCalls, limits_.calls_per_peer);
  if (is_stream && all_.streams >= limits_.streams) return TooManyCalls(kStreams, limits_.streams);
  if (is_stream && of_peer.streams >= limits_.streams_per_peer) {
    return TooManyCallsOfPeer(kStreams, limits_.streams_per_peer);
  }
  all_.Add(1, is_stream);
  peers_[peer].Add(1, is_stream);
  return Permit(this, [this, peer, is_stream](void* /*this*/) { Leave(peer, is_stream); });
}

void LiveCalls::Leave(const std::string& peer, bool is_stream) {
  const std::lock_guard lock(mutex_);
  all_.Add(-1, is_stream);
  const auto found = peers_.find(peer);
  found->second.Add(-1, is_stream);
  if (found->second.calls == 0) peers_.erase(found);
}

int LiveCalls::live() const {
  const std::lock_guard lock(mutex_);
  return all_.calls;
}

}  // namespace ricochet::server
