#include "client/cli/line_blocks.h"

#include <algorithm>

namespace ricochet::cli {

LineBlocks::LineBlocks(const SweepRequest& request, const SweepChunk& pending)
    : range_start_(request.first_index), start_(pending.first_index), columns_(request.columns.size()) {
  Append(pending, 0, pending.count);
}

std::vector<SweepChunk> LineBlocks::Add(const SweepChunk& chunk) {
  std::vector<SweepChunk> blocks;
  int64_t taken = 0;
  do {
    const int64_t end = (start_ / kPoints + 1) * kPoints;
    const int64_t count = std::min(end - start_ - count_, chunk.count - taken);
    Append(chunk, taken, count);
    taken += count;
    const bool last = chunk.summary.has_value() && taken == chunk.count;
    if (start_ + count_ < end && !last) continue;
    SweepChunk& block = blocks.emplace_back(pending());
    block.points_done = start_ + count_ - range_start_;
    block.points_total = chunk.points_total;
    block.engine = chunk.engine;
    if (last) block.summary = Joined(*chunk.summary, {});  // Joining drops the time.
    start_ += count_;
    count_ = 0;
    for (std::vector<double>& column : columns_) column.clear();
    regimes_.clear();
  } while (taken < chunk.count);
  return blocks;
}

SweepChunk LineBlocks::pending() const {
  SweepChunk chunk = {.first_index = start_, .count = count_, .values = {}, .regimes = regimes_, .engine = {}};
  for (const std::vector<double>& column : columns_) {
    chunk.values.insert(chunk.values.end(), column.begin(), column.end());
  }
  return chunk;
}

void LineBlocks::Append(const SweepChunk& chunk, int64_t first, int64_t count) {
  for (size_t c = 0; c < columns_.size(); ++c) {
    const auto values = chunk.values.begin() + static_cast<int64_t>(c) * chunk.count + first;
    columns_[c].insert(columns_[c].end(), values, values + count);
  }
  if (!chunk.regimes.empty()) {
    regimes_.insert(regimes_.end(), chunk.regimes.begin() + first, chunk.regimes.begin() + first + count);
  }
  count_ += count;
}

}  // namespace ricochet::cli
