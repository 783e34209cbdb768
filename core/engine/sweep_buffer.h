// SweepBuffer: the values of consecutive points of a sweep, which several threads fill in any order and which leave in
// the order of the points.

#ifndef RICOCHET_CORE_ENGINE_SWEEP_BUFFER_H_
#define RICOCHET_CORE_ENGINE_SWEEP_BUFFER_H_

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "core/rows/row_solver.h"
#include "ricochet/outcome.h"
#include "ricochet/sweep.h"

namespace ricochet {

// Thread safety: one thread at a time; but several threads may ask for the sinks of different blocks that they have
// claimed, and write to them.
class SweepBuffer {
 public:
  // Points [first, first + count) of the grid.
  struct Block {
    int64_t first = 0;
    int64_t count = 0;
  };

  // Room for `room` >= 1 points from `first` on, with `columns` values each, and with a regime and a status if wanted.
  SweepBuffer(int64_t first, int64_t room, size_t columns, bool with_regimes);

  // Claims the first points that nobody has claimed yet, at most `most` of them; nothing if there are none.
  std::optional<Block> Claim(int64_t most);

  bool has_unclaimed() const { return !unclaimed_.empty(); }
  bool Contains(const Block& block) const { return block.first >= first_ && block.first < first_ + room_; }

  // Returns the places for the results of a block's points, with regimes and statuses only if these are wanted.
  RowSink SinkOf(const Block& block, SweepSummary& counts);

  // Says that the first `count` points of a block that was claimed are computed. The rest may be claimed again.
  void Finish(const Block& block, int64_t count, const SweepSummary& tallies);

  bool is_complete() const { return ready_ == room_; }
  // True if the next point to leave is computed.
  bool has_ready() const { return ready_ > emitted_; }

  // Moves all points that can leave now into a chunk: its index, count, values, regimes and statuses. Adds them to
  // `tallies`.
  SweepChunk Emit(SweepSummary& tallies);

 private:
  struct Part {
    int64_t count = 0;
    SweepSummary tallies;
  };
  // Copies the points [emitted_, ready_).
  void CopyReady(SweepChunk& chunk) const;

  const int64_t first_;
  const int64_t room_;
  const size_t columns_;
  std::vector<double> values_;  // Column after column, with room_ values each.
  std::vector<Regime> regimes_;
  std::vector<RowStatus> statuses_;
  // Points by their distance from first_.
  std::map<int64_t, int64_t> unclaimed_;  // Runs of points: where each starts, and its length.
  std::map<int64_t, Part> computed_;      // Blocks behind one that is not computed yet.
  int64_t ready_ = 0;                     // Every point before this one is computed.
  int64_t emitted_ = 0;                   // Every point before this one has left.
  SweepSummary ready_tallies_;            // They count the points that can leave.
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_ENGINE_SWEEP_BUFFER_H_
