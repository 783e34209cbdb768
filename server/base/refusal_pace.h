// RefusalPace: how soon a peer is told that its call is refused.
//
// A client that repeats refused calls at once would keep the server busy with refusals alone. A peer is told at once as
// long as it has few of them; one that goes on hears of 50 refusals a second, and its further calls wait for theirs
// (generic cell rate algorithm).

#ifndef RICOCHET_SERVER_BASE_REFUSAL_PACE_H_
#define RICOCHET_SERVER_BASE_REFUSAL_PACE_H_

#include <algorithm>
#include <chrono>
#include <map>
#include <string>

namespace ricochet::server {

// Thread safety: one thread at a time.
class RefusalPace {
 public:
  using Time = std::chrono::steady_clock::time_point;

  // The number of refusals that a peer hears of at once, and the time between two later ones.
  static constexpr int kAtOnce = 100;
  static constexpr std::chrono::milliseconds kBetween{20};

  // Counts a refusal of a call that `peer` makes `now`, and returns when to tell it: now or later.
  Time Next(const std::string& peer, Time now) {
    std::erase_if(paid_until_, [now](const auto& entry) { return entry.second <= now; });
    Time& paid_until = paid_until_.try_emplace(peer, now).first->second;
    paid_until += kBetween;
    return std::max(now, paid_until - kAtOnce * kBetween);
  }

 private:
  std::map<std::string, Time> paid_until_;  // For each peer, the end of the time that its refusals stand for.
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_BASE_REFUSAL_PACE_H_
