// HelpedRun: the part that all calls share in which other threads help: it asks for helpers, waits for them, rethrows
// the exception that one of them meets, and does not end before they do.
//
//   Thread of the call: Begin(); then, again and again: take something to do and do it, AskForHelp(lock), Wait(lock).
//   Each helper:        take something to do and do it, until there is nothing or `gives_way` says so.
//
// The mutex guards what the threads take their work from, which belongs to the owner of this object.

#ifndef RICOCHET_CORE_ENGINE_HELPED_RUN_H_
#define RICOCHET_CORE_ENGINE_HELPED_RUN_H_

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>

#include "absl/functional/any_invocable.h"
#include "absl/functional/function_ref.h"
#include "ricochet/helpers.h"

namespace ricochet {

class HelpedRun {
 public:
  // Says whether one more helper would find something to do. It is called with the mutex locked.
  using HasWork = absl::AnyInvocable<bool()>;
  // The work of a helper; see Helpers::Help. Called on several threads at once, with the mutex unlocked.
  using Help = absl::AnyInvocable<void(absl::FunctionRef<bool()> gives_way)>;

  // Null stands for no helpers.
  HelpedRun(std::shared_ptr<Helpers> helpers, HasWork has_work, Help help);
  // Stops, and waits until nobody helps any more. So this must be the last member of its owner.
  ~HelpedRun();
  HelpedRun(const HelpedRun&) = delete;
  HelpedRun& operator=(const HelpedRun&) = delete;

  std::mutex& mutex() const { return mutex_; }
  int most_helpers() const { return most_; }

  // Helpers and their waiting caller ask this while they compute.
  bool is_stopping() const { return stopping_; }
  void Stop() { stopping_ = true; }

  // Says that the run begins now. Only the first call has an effect.
  void Begin();

  // The functions below are called on the thread of the call with the mutex locked.
  // Asks for as many helpers as could find something to do, once the run has lasted for a millisecond. Unlocks the
  // mutex meanwhile.
  void AskForHelp(std::unique_lock<std::mutex>& lock);
  bool is_helped() const { return helping_ > 0; }
  // Waits until a helper has told something, or a millisecond.
  void Wait(std::unique_lock<std::mutex>& lock);
  // Throws the exception that a helper has met, if one has.
  void ThrowWhatAHelperMet() const;

  // Helpers call this, with the mutex locked, if the call waits for what they have done.
  void Tell() { changed_.notify_all(); }

 private:
  using Clock = std::chrono::steady_clock;

  void RunHelper(absl::FunctionRef<bool()> gives_way);

  const std::shared_ptr<Helpers> helpers_;
  const int most_;
  HasWork has_work_;
  Help help_;
  std::optional<Clock::time_point> help_from_;
  std::atomic<bool> stopping_ = false;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  int helping_ = 0;  // Helpers that were asked for and have not ended.
  std::exception_ptr failure_;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_ENGINE_HELPED_RUN_H_
