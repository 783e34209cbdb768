#include "core/engine/piece_run.h"

#include <mutex>
#include <utility>

namespace ricochet {

PieceRun::PieceRun(size_t pieces, std::shared_ptr<Helpers> helpers, MakeWork make_work)
    : pieces_(pieces),
      make_work_(std::move(make_work)),
      helped_(
          std::move(helpers), [this] { return next_ < pieces_; },
          [this](absl::FunctionRef<bool()> gives_way) { Help(gives_way); }) {}

bool PieceRun::Run(Work own, absl::FunctionRef<bool()> stopped) {
  helped_.Begin();
  std::unique_lock lock(helped_.mutex(), std::defer_lock);
  while (ComputeNext(own, stopped)) {
    if (helped_.most_helpers() == 0) continue;
    lock.lock();
    helped_.AskForHelp(lock);
    lock.unlock();
  }
  if (helped_.is_stopping()) return false;
  lock.lock();
  while (helped_.is_helped()) {
    helped_.Wait(lock);
    lock.unlock();
    if (stopped()) return false;
    lock.lock();
  }
  helped_.ThrowWhatAHelperMet();
  return true;
}

bool PieceRun::ComputeNext(Work& work, absl::FunctionRef<bool()> stopped) {
  const size_t piece = next_++;
  if (piece >= pieces_) return false;
  if (work(piece, stopped)) return true;
  helped_.Stop();
  return false;
}

void PieceRun::Help(absl::FunctionRef<bool()> gives_way) {
  Work work = make_work_();
  while (ComputeNext(work, [this] { return helped_.is_stopping(); }) && !gives_way()) continue;
}

}  // namespace ricochet
