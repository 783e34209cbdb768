#include "server/transport/connection_counts.h"

namespace ricochet::server {

ConnectionCounts::Decision ConnectionCounts::Add(const std::string& peer) {
  if (in_all_ >= limits_.in_all) return Decision::kTooMany;
  const auto found = per_peer_.find(peer);
  if (found != per_peer_.end() && found->second >= limits_.per_peer) return Decision::kTooManyOfPeer;
  ++in_all_;
  ++per_peer_[peer];
  return Decision::kAccepted;
}

void ConnectionCounts::Remove(const std::string& peer) {
  const auto found = per_peer_.find(peer);
  --in_all_;
  if (--found->second == 0) per_peer_.erase(found);
}

}  // namespace ricochet::server
