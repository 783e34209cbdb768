#include "server/admission/call_memory.h"

#include "server/base/refusals.h"

namespace ricochet::server {
namespace {

bool Fits(int64_t held, int64_t bytes, int64_t limit) { return held == 0 || bytes <= limit - held; }

}  // namespace

absl::StatusOr<CallMemory::Hold> CallMemory::Take(absl::FunctionRef<std::string()> peer, int64_t bytes) {
  if (bytes < kUncounted) return Hold();
  const std::string name = peer();
  const std::lock_guard lock(mutex_);
  const auto found = held_by_peer_.find(name);
  const int64_t held_by_peer = found == held_by_peer_.end() ? 0 : found->second;
  if (!Fits(held_, bytes, bytes_)) return NoMemory(bytes_);
  if (!Fits(held_by_peer, bytes, bytes_of_peer_)) return NoMemoryOfPeer(bytes_of_peer_);
  held_ += bytes;
  held_by_peer_[name] += bytes;
  return Hold(this, [this, name, bytes](void* /*this*/) { GiveBack(name, bytes); });
}

void CallMemory::GiveBack(const std::string& peer, int64_t bytes) {
  const std::lock_guard lock(mutex_);
  held_ -= bytes;
  const auto found = held_by_peer_.find(peer);
  found->second -= bytes;
  if (found->second == 0) held_by_peer_.erase(found);
}

int64_t CallMemory::held() const {
  const std::lock_guard lock(mutex_);
  return held_;
}

}  // namespace ricochet::server
