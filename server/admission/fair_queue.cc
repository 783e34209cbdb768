#include "server/admission/fair_queue.h"

#include <algorithm>

namespace ricochet::server {

void FairQueue::Add(Item& item) {
  const auto [found, is_new] = peers_.try_emplace(item.peer);
  Peer& peer = found->second;
  if (is_new) peer.served_s = level_s_;
  item.ticket_ = ++tickets_;
  peer.waiting.emplace(std::pair(item.deadline, item.ticket_), &item);
  peer.waiting_s += item.expected_s;
  ++size_;
}

void FairQueue::Remove(const Item& item) {
  const auto found = peers_.find(item.peer);
  found->second.waiting.erase({item.deadline, item.ticket_});
  found->second.waiting_s -= item.expected_s;
  --size_;
  ForgetIfIdle(found);
}

FairQueue::Item* FairQueue::Next() {
  auto next = peers_.end();
  for (auto peer = peers_.begin(); peer != peers_.end(); ++peer) {
    if (peer->second.waiting.empty()) continue;
    if (next == peers_.end() || peer->second.served_s < next->second.served_s) next = peer;
  }
  if (next == peers_.end()) return nullptr;
  Peer& peer = next->second;
  Item* const item = peer.waiting.begin()->second;
  level_s_ = std::max(level_s_, peer.served_s);
  peer.served_s += item->expected_s;
  ++peer.computing;
  Remove(*item);
  return item;
}

void FairQueue::Settle(const Item& item, double computed_s) {
  const auto found = peers_.find(item.peer);
  found->second.served_s += computed_s - item.expected_s;
  --found->second.computing;
  ForgetIfIdle(found);
}

double FairQueue::ExpectedAhead(const Item& item) const {
  double own_s = 0.0;
  const auto own = peers_.find(item.peer);
  if (own != peers_.end()) {
    for (const auto& [place, waiting] : own->second.waiting) {
      if (waiting->deadline <= item.deadline) own_s += waiting->expected_s;
    }
  }
  // Peers share time equally, so while this peer computes all that and the call, every other one gets at most as much.
  double others_s = 0.0;
  for (auto peer = peers_.begin(); peer != peers_.end(); ++peer) {
    if (peer != own) others_s += std::min(peer->second.waiting_s, own_s + item.expected_s);
  }
  return own_s + others_s;
}

void FairQueue::ForgetIfIdle(std::map<std::string, Peer>::iterator peer) {
  if (peer->second.waiting.empty() && peer->second.computing == 0) peers_.erase(peer);
}

}  // namespace ricochet::server
