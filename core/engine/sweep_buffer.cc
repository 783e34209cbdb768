#include "core/engine/sweep_buffer.h"

#include <algorithm>
#include <utility>

#include "absl/types/span.h"

namespace ricochet {

SweepBuffer::SweepBuffer(int64_t first, int64_t room, size_t columns, bool with_regimes)
    : first_(first),
      room_(room),
      columns_(columns),
      values_(static_cast<size_t>(room) * columns),
      regimes_(with_regimes ? static_cast<size_t>(room) : 0),
      statuses_(regimes_.size()),
      unclaimed_({{0, room}}) {}

std::optional<SweepBuffer::Block> SweepBuffer::Claim(int64_t most) {
  if (unclaimed_.empty()) return std::nullopt;
  const auto [start, length] = *unclaimed_.begin();
  unclaimed_.erase(unclaimed_.begin());
  const int64_t count = std::min(most, length);
  if (count < length) unclaimed_.emplace(start + count, length - count);
  return Block{.first = first_ + start, .count = count};
}

RowSink SweepBuffer::SinkOf(const Block& block, SweepSummary& counts) {
  const int64_t start = block.first - first_;
  RowSink sink = {.columns = {}, .regimes = {}, .statuses = {}, .counts = counts};
  for (size_t c = 0; c < columns_; ++c) {
    sink.columns.push_back(values_.data() + static_cast<int64_t>(c) * room_ + start);
  }
  if (!regimes_.empty()) {
    const auto count = static_cast<size_t>(block.count);
    sink.regimes = absl::MakeSpan(regimes_).subspan(static_cast<size_t>(start), count);
    sink.statuses = absl::MakeSpan(statuses_).subspan(static_cast<size_t>(start), count);
  }
  return sink;
}

void SweepBuffer::Finish(const Block& block, int64_t count, const SweepSummary& tallies) {
  const int64_t start = block.first - first_;
  if (count < block.count) unclaimed_.emplace(start + count, block.count - count);
  computed_.emplace(start, Part{.count = count, .tallies = tallies});
  while (!computed_.empty() && computed_.begin()->first == ready_) {
    const Part& part = computed_.begin()->second;
    ready_ += part.count;
    ready_tallies_ = Joined(ready_tallies_, part.tallies);
    computed_.erase(computed_.begin());
  }
}

SweepChunk SweepBuffer::Emit(SweepSummary& tallies) {
  SweepChunk chunk = {.first_index = first_ + emitted_, .count = ready_ - emitted_};
  if (chunk.count == room_) {
    chunk.values = std::move(values_);
    chunk.regimes = std::move(regimes_);
    chunk.statuses = std::move(statuses_);
  } else {
    CopyReady(chunk);
  }
  emitted_ = ready_;
  tallies = Joined(tallies, std::exchange(ready_tallies_, {}));
  return chunk;
}

void SweepBuffer::CopyReady(SweepChunk& chunk) const {
  chunk.values.reserve(static_cast<size_t>(chunk.count) * columns_);
  for (size_t c = 0; c < columns_; ++c) {
    const auto column = values_.begin() + static_cast<int64_t>(c) * room_;
    chunk.values.insert(chunk.values.end(), column + emitted_, column + ready_);
  }
  if (regimes_.empty()) return;
  chunk.regimes.assign(regimes_.begin() + emitted_, regimes_.begin() + ready_);
  chunk.statuses.assign(statuses_.begin() + emitted_, statuses_.begin() + ready_);
}

}  // namespace ricochet
