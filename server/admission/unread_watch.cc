#include "server/admission/unread_watch.h"

#include <algorithm>
#include <utility>

namespace ricochet::server {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

// A refusal is small. Only a peer that reads nothing at all keeps it waiting for so long.
constexpr milliseconds kTimeOfRefusal(1000);

}  // namespace

UnreadWatch::UnreadWatch(milliseconds limit) : limit_(limit), thread_([this] { Watch(); }) {}

UnreadWatch::~UnreadWatch() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  stopped_.notify_all();
  thread_.join();
}

void UnreadWatch::Watch() {
  // The thread looks at the writes from time to time, so that a write need not wake it.
  const milliseconds between_looks = std::clamp(limit_ / 10, milliseconds(10), milliseconds(1000));
  std::unique_lock lock(mutex_);
  while (!stopped_.wait_for(lock, between_looks, [this] { return stopping_; })) {
    Cut();
  }
}

void UnreadWatch::Cut() {
  const auto now = Clock::now();
  for (Entry& write : writes_) {
    if (now - write.start < limit_) break;
    if (!write.is_cut) write.context->TryCancel();
    write.is_cut = true;
  }
  for (auto& [key, answer] : answers_) {
    if (!answer.end.has_value() || now < *answer.end) continue;
    answer.context->TryCancel();
    answer.end.reset();
  }
}

void UnreadWatch::Sends(const grpc::ServerContext& context, bool is_refused, std::shared_ptr<void> ending) {
  const milliseconds limit = is_refused ? std::min(limit_, kTimeOfRefusal) : limit_;
  const std::lock_guard lock(mutex_);
  const auto found = answers_.find(&context);
  if (found == answers_.end()) return;
  found->second.end = Clock::now() + limit;
  found->second.ending = std::move(ending);
}

UnreadWatch::Answer::Answer(UnreadWatch& watch, grpc::ServerContext& context) : watch_(watch), context_(context) {
  const std::lock_guard lock(watch_.mutex_);
  watch_.answers_.emplace(&context, Waiting{.context = &context, .end = {}, .ending = nullptr});
}

UnreadWatch::Answer::~Answer() {
  // The destructors of what is let go of may take long, so that the mutex is unlocked for them.
  const auto let_go = [this] {
    const std::lock_guard lock(watch_.mutex_);
    return watch_.answers_.extract(&context_);
  }();
}

UnreadWatch::Write::Write(UnreadWatch& watch, grpc::ServerContext& context) : watch_(watch) {
  const std::lock_guard lock(watch_.mutex_);
  entry_ = watch_.writes_.insert(watch_.writes_.end(), {.context = &context, .start = Clock::now()});
}

UnreadWatch::Write::~Write() {
  const std::lock_guard lock(watch_.mutex_);
  watch_.writes_.erase(entry_);
}

std::chrono::duration<double> UnreadWatch::Write::waited() const { return Clock::now() - entry_->start; }

bool UnreadWatch::Write::is_cut() const {
  const std::lock_guard lock(watch_.mutex_);
  return entry_->is_cut;
}

}  // namespace ricochet::server
