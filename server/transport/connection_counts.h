// ConnectionCounts: how many connections are open, in all and for each peer, and whether one more may be.

#ifndef RICOCHET_SERVER_TRANSPORT_CONNECTION_COUNTS_H_
#define RICOCHET_SERVER_TRANSPORT_CONNECTION_COUNTS_H_

#include <string>
#include <unordered_map>

namespace ricochet::server {

// Both limits are at least 1.
struct ConnectionLimits {
  int in_all = 4096;
  int per_peer = 2048;

  friend bool operator==(const ConnectionLimits&, const ConnectionLimits&) = default;
};

class ConnectionCounts {
 public:
  enum class Decision { kAccepted, kTooMany, kTooManyOfPeer };

  explicit ConnectionCounts(const ConnectionLimits& limits) : limits_(limits) {}

  // Counts a connection of `peer` if the limits allow it.
  Decision Add(const std::string& peer) {
    if (in_all_ >= limits_.in_all) return Decision::kTooMany;
    const auto found = per_peer_.find(peer);
    if (found != per_peer_.end() && found->second >= limits_.per_peer) return Decision::kTooManyOfPeer;
    ++in_all_;
    ++per_peer_[peer];
    return Decision::kAccepted;
  }

  // Forgets a connection that Add has accepted.
  void Remove(const std::string& peer) {
    const auto found = per_peer_.find(peer);
    --in_all_;
    if (--found->second == 0) per_peer_.erase(found);
  }

  int in_all() const { return in_all_; }

 private:
  const ConnectionLimits limits_;
  int in_all_ = 0;
  std::unordered_map<std::string, int> per_peer_;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_TRANSPORT_CONNECTION_COUNTS_H_
