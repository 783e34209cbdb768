#include "server/base/refusal_pace.h"

#include <algorithm>

namespace ricochet::server {

RefusalPace::Time RefusalPace::Next(const std::string& peer, Time now) {
  std::erase_if(paid_until_, [now](const auto& entry) { return entry.second <= now; });
  Time& paid_until = paid_until_.try_emplace(peer, now).first->second;
  paid_until += kBetween;
  return std::max(now, paid_until - kAtOnce * kBetween);
}

}  // namespace ricochet::server
