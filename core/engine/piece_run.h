// PieceRun: pieces of a call that do not depend on each other, computed by the thread that asks and by others that
// help.

#ifndef RICOCHET_CORE_ENGINE_PIECE_RUN_H_
#define RICOCHET_CORE_ENGINE_PIECE_RUN_H_

#include <atomic>
#include <cstddef>
#include <memory>

#include "absl/functional/any_invocable.h"
#include "absl/functional/function_ref.h"
#include "core/engine/helped_run.h"
#include "ricochet/helpers.h"

namespace ricochet {

// Thread safety: one thread at a time.
class PieceRun {
 public:
  // Computes a piece; returns false if it was stopped.
  using Work = absl::AnyInvocable<bool(size_t piece, absl::FunctionRef<bool()> stopped)>;
  // Makes the work of a helper; called on the thread that helps.
  using MakeWork = absl::AnyInvocable<Work()>;

  // The pieces are 0 ... pieces - 1. Null stands for no helpers, who are asked once the run has lasted for a
  // millisecond.
  PieceRun(size_t pieces, std::shared_ptr<Helpers> helpers, MakeWork make_work);

  // Computes each piece once, by `own` on this thread. `stopped` is asked on this thread alone: by `own`, and every
  // millisecond in which it waits for helpers. Returns false if it was stopped. An exception that a helper meets is
  // thrown here.
  bool Run(Work own, absl::FunctionRef<bool()> stopped);

 private:
  // Computes the next piece; returns false if there is none or it was stopped.
  bool ComputeNext(Work& work, absl::FunctionRef<bool()> stopped);
  void Help(absl::FunctionRef<bool()> gives_way);

  const size_t pieces_;
  MakeWork make_work_;
  std::atomic<size_t> next_ = 0;
  HelpedRun helped_;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_ENGINE_PIECE_RUN_H_
