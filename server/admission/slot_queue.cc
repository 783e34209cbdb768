#include "server/admission/slot_queue.h"

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

absl::Status SlotQueue::Enter(Waiter& waiter, absl::FunctionRef<bool()> is_gone) {
  std::unique_lock lock(mutex_);
  if (closed_) return Draining();
  if (absl::Status refusal = WhyRefused(waiter); !refusal.ok()) {
    const auto place = refused_.insert(refused_.end(), &waiter);
    const absl::Status ended = WaitUntil(pace_.Next(waiter.peer, Clock::now()), waiter, is_gone, lock);
    refused_.erase(place);
    return ended.ok() ? refusal : ended;
  }
  queue_.Add(waiter);
  LetIn();
  absl::Status ended = WaitUntil(Time::max(), waiter, is_gone, lock);
  if (waiter.state_ == Waiter::State::kWaiting) queue_.Remove(waiter);
  return ended;
}

bool SlotQueue::TryEnter(Waiter& waiter) {
  const std::lock_guard lock(mutex_);
  if (closed_ || computing_.size() >= slots_ || queue_.size() > 0) return false;
  queue_.Add(waiter);
  LetIn();
  return true;
}

double SlotQueue::Leave(Waiter& waiter) {
  const std::lock_guard lock(mutex_);
  const double computed_s = Seconds(Clock::now() - waiter.started_).count();
  computing_.erase(waiter.place_);
  queue_.Settle(waiter, computed_s);
  LetIn();
  return computed_s;
}

void SlotQueue::Close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  const auto turn_away = [](Waiter& waiter) {
    waiter.state_ = Waiter::State::kTurnedAway;
    waiter.changed_.notify_one();
  };
  while (FairQueue::Item* const item = queue_.Next()) turn_away(static_cast<Waiter&>(*item));
  for (Waiter* const waiter : refused_) turn_away(*waiter);
}

size_t SlotQueue::waiting() const {
  const std::lock_guard lock(mutex_);
  return queue_.size() + refused_.size();
}

size_t SlotQueue::computing() const {
  const std::lock_guard lock(mutex_);
  return computing_.size();
}

void SlotQueue::LetIn() {
  while (computing_.size() < slots_) {
    FairQueue::Item* const item = queue_.Next();
    if (item == nullptr) return;
    Start(static_cast<Waiter&>(*item));
  }
}

void SlotQueue::Start(Waiter& waiter) {
  waiter.state_ = Waiter::State::kComputing;
  waiter.started_ = Clock::now();
  waiter.place_ = computing_.insert(computing_.end(), &waiter);
  waiter.changed_.notify_one();
}

double SlotQueue::ExpectedWait(const Waiter& waiter) const {
  if (computing_.size() < slots_) return 0.0;
  double work_s = queue_.ExpectedAhead(waiter);
  const Time now = Clock::now();
  for (const Waiter* const computing : computing_) {
    work_s += std::max(computing->expected_s - Seconds(now - computing->started_).count(), 0.0);
  }
  return work_s / static_cast<double>(slots_);
}

absl::Status SlotQueue::WhyRefused(const Waiter& waiter) const {
  const double wait_s = ExpectedWait(waiter);
  if (queue_.size() >= most_waiting_) return QueueFull(most_waiting_, Seconds(wait_s));
  // Without a wait a call is always let in, so that one expectation that is too long does not keep out all later calls.
  if (wait_s == 0.0 || waiter.deadline == Time::max()) return absl::OkStatus();
  const double left_s = Seconds(waiter.deadline - Clock::now()).count();
  return wait_s + kSpareTime * waiter.expected_s > left_s ? Overloaded(Seconds(wait_s)) : absl::OkStatus();
}

absl::Status SlotQueue::WaitUntil(Time end, Waiter& waiter, absl::FunctionRef<bool()> is_gone,
                                  std::unique_lock<std::mutex>& lock) {
  while (waiter.state_ == Waiter::State::kWaiting) {
    const Time now = Clock::now();
    if (now >= waiter.deadline) return absl::DeadlineExceededError("the deadline passed before the call's turn came");
    if (now >= end) return absl::OkStatus();
    waiter.changed_.wait_until(lock, std::min({end, waiter.deadline, now + kBetweenLooks}));
    if (waiter.state_ != Waiter::State::kWaiting) break;
    lock.unlock();
    const bool gone = is_gone();
    lock.lock();
    if (gone && waiter.state_ == Waiter::State::kWaiting) {
      return absl::CancelledError("the caller gave up before the call's turn came");
    }
  }
  return waiter.state_ == Waiter::State::kTurnedAway ? Draining() : absl::OkStatus();
}

}  // namespace ricochet::server
