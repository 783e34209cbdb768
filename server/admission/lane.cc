#include "server/admission/lane.h"

#include <algorithm>

#include "server/base/refusals.h"

namespace ricochet::server {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

// The time between two looks at whether the caller of a call that waits has given up.
constexpr std::chrono::milliseconds kBetweenLooks(250);

// A call is let in if it could take this many times as long as it is expected to and still be in time.
constexpr double kSpareTime = 1.5;

}  // namespace

absl::Status Lane::Enter(Visitor& visitor, absl::FunctionRef<bool()> is_gone) {
  std::unique_lock lock(mutex_);
  if (closed_) return Draining();
  if (absl::Status refusal = WhyRefused(visitor); !refusal.ok()) {
    const auto place = refused_.insert(refused_.end(), &visitor);
    const absl::Status ended = WaitUntil(pace_.Next(visitor.peer, Clock::now()), visitor, is_gone, lock);
    refused_.erase(place);
    return ended.ok() ? refusal : ended;
  }
  queue_.Add(visitor);
  LetIn();
  absl::Status ended = WaitUntil(Time::max(), visitor, is_gone, lock);
  if (visitor.state == Visitor::State::kWaiting) queue_.Remove(visitor);
  return ended;
}

bool Lane::TryEnter(Visitor& visitor) {
  const std::lock_guard lock(mutex_);
  if (closed_ || computing_.size() >= slots_ || queue_.size() > 0) return false;
  queue_.Add(visitor);
  LetIn();
  return true;
}

double Lane::Leave(Visitor& visitor) {
  const std::lock_guard lock(mutex_);
  const double computed_s = Seconds(Clock::now() - visitor.started).count();
  computing_.erase(visitor.place);
  queue_.Settle(visitor, computed_s);
  LetIn();
  return computed_s;
}

void Lane::Close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  const auto turn_away = [](Visitor& visitor) {
    visitor.state = Visitor::State::kTurnedAway;
    visitor.turn.notify_one();
  };
  while (FairQueue::Item* const item = queue_.Next()) turn_away(static_cast<Visitor&>(*item));
  for (Visitor* const visitor : refused_) turn_away(*visitor);
}

size_t Lane::waiting() const {
  const std::lock_guard lock(mutex_);
  return queue_.size() + refused_.size();
}

size_t Lane::computing() const {
  const std::lock_guard lock(mutex_);
  return computing_.size();
}

void Lane::LetIn() {
  while (computing_.size() < slots_) {
    FairQueue::Item* const item = queue_.Next();
    if (item == nullptr) return;
    Start(static_cast<Visitor&>(*item));
  }
}

void Lane::Start(Visitor& visitor) {
  visitor.state = Visitor::State::kComputing;
  visitor.started = Clock::now();
  visitor.place = computing_.insert(computing_.end(), &visitor);
  visitor.turn.notify_one();
}

double Lane::ExpectedWait(const Visitor& visitor) const {
  if (computing_.size() < slots_) return 0.0;
  double work_s = queue_.ExpectedAhead(visitor);
  const Time now = Clock::now();
  for (const Visitor* const computing : computing_) {
    work_s += std::max(computing->expected_s - Seconds(now - computing->started).count(), 0.0);
  }
  return work_s / static_cast<double>(slots_);
}

absl::Status Lane::WhyRefused(const Visitor& visitor) const {
  const double wait_s = ExpectedWait(visitor);
  if (queue_.size() >= most_waiting_) return Overloaded(Seconds(wait_s));
  // Without a wait a call is always let in, so that one expectation that is too long does not keep out all later calls.
  if (wait_s == 0.0 || visitor.deadline == Time::max()) return absl::OkStatus();
  const double left_s = Seconds(visitor.deadline - Clock::now()).count();
  return wait_s + kSpareTime * visitor.expected_s > left_s ? Overloaded(Seconds(wait_s)) : absl::OkStatus();
}

absl::Status Lane::WaitUntil(Time end, Visitor& visitor, absl::FunctionRef<bool()> is_gone,
                             std::unique_lock<std::mutex>& lock) {
  while (visitor.state == Visitor::State::kWaiting) {
    const Time now = Clock::now();
    if (now >= visitor.deadline) return absl::DeadlineExceededError("the deadline passed before the call's turn came");
    if (now >= end) return absl::OkStatus();
    visitor.turn.wait_until(lock, std::min({end, visitor.deadline, now + kBetweenLooks}));
    if (visitor.state != Visitor::State::kWaiting) break;
    lock.unlock();
    const bool gone = is_gone();
    lock.lock();
    if (gone && visitor.state == Visitor::State::kWaiting) {
      return absl::CancelledError("the caller gave up before the call's turn came");
    }
  }
  return visitor.state == Visitor::State::kTurnedAway ? Draining() : absl::OkStatus();
}

}  // namespace ricochet::server
