// LineBlocks: cuts a sweep into lines of JSON at places that depend on the grid alone, not on the chunks in which the
// points arrive, so that the text of a sweep is the same whenever and however often it was taken up again.

#ifndef RICOCHET_CLIENT_CLI_LINE_BLOCKS_H_
#define RICOCHET_CLIENT_CLI_LINE_BLOCKS_H_

#include <cstdint>
#include <vector>

#include "ricochet/sweep.h"

namespace ricochet::cli {

class LineBlocks {
 public:
  // A block ends before each index that is a multiple of this, and at the end of the range.
  static constexpr int64_t kPoints = 1024;

  // `pending` are points that an earlier run has received but not written; an empty one starts at the next point.
  LineBlocks(const SweepRequest& request, const SweepChunk& pending);

  // Returns the blocks that are complete with the points of `chunk`, the next one. Their tallies are empty; the last
  // block of all has the summary of the chunk, without its time.
  std::vector<SweepChunk> Add(const SweepChunk& chunk);

  // Returns the points that wait for more.
  SweepChunk pending() const;

 private:
  void Append(const SweepChunk& chunk, int64_t first, int64_t count);

  int64_t range_start_;
  int64_t start_;                             // The first point that waits.
  int64_t count_ = 0;                         // The number of points that wait.
  std::vector<std::vector<double>> columns_;  // Their values.
  std::vector<Regime> regimes_;
};

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_LINE_BLOCKS_H_
