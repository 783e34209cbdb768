#include "client/chunk_checker.h"

#include <algorithm>
#include <limits>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "core/types/grid.h"
#include "proto/wire/sweep.h"

namespace ricochet {
namespace {

std::optional<int64_t> EndIndex(const SweepRequest& request) {
  if (request.end_index.has_value()) return request.end_index;
  if (!ValidateAxes(request.grid).empty()) return std::nullopt;
  return PointCount(request.grid);
}

std::string EnginesDiffer(int64_t index, const std::string& fingerprint, const std::string& before) {
  return absl::StrCat("the points from ", index, " on come from the engine \"", absl::CEscape(fingerprint),
                      "\", those before from \"", absl::CEscape(before), "\"");
}

// The result is unsigned, because the ends of a range that no server answers may differ by more than an int64_t holds.
uint64_t PointsLeft(int64_t next_index, int64_t end_index) {
  if (end_index <= next_index) return 0;
  return static_cast<uint64_t>(end_index) - static_cast<uint64_t>(next_index);
}

}  // namespace

absl::Status OtherEngine(int64_t index, const std::string& fingerprint, const std::string& before) {
  return absl::FailedPreconditionError(
      absl::StrCat(EnginesDiffer(index, fingerprint, before),
                   ": they may differ in their last bits and must not be mixed; start the sweep anew"));
}

ChunkChecker::ChunkChecker(const SweepRequest& request)
    : columns_(static_cast<int64_t>(request.columns.size())),
      with_regime_(request.with_regime),
      first_index_(request.first_index),
      next_index_(request.first_index),
      end_index_(EndIndex(request)),
      seal_(request) {}

absl::StatusOr<SweepChunk> ChunkChecker::Accept(const v1::SweepResponse& message) {
  if (absl::Status status = seal_.Check(message); !status.ok()) return status;
  if (message.values().size() % sizeof(double) != 0) {
    return absl::DataLossError(absl::StrCat("the sweep's chunk at point ", message.first_index(), " has ",
                                            message.values().size(), " bytes of values, which are no whole doubles"));
  }
  SweepChunk chunk = FromProto(message);
  if (absl::Status status = Check(chunk); !status.ok()) return status;
  JoinCalls(chunk);
  return chunk;
}

void ChunkChecker::StartCall() {
  earlier_ = Joined(earlier_, tallies_.counted());
  tallies_ = TallyChecker();
}

void ChunkChecker::JoinCalls(SweepChunk& chunk) const {
  chunk.points_done = static_cast<int64_t>(PointsLeft(first_index_, next_index_));
  chunk.points_total = static_cast<int64_t>(PointsLeft(first_index_, *end_index_));
  if (earlier_.points == 0) return;
  chunk.tallies = Joined(earlier_, chunk.tallies);
  // The time of the last call is not that of the sweep.
  if (chunk.summary.has_value()) chunk.summary = chunk.tallies;
}

absl::Status ChunkChecker::Check(const SweepChunk& chunk) {
  if (absl::Status status = CheckEngine(chunk); !status.ok()) return status;
  if (absl::Status status = CheckSize(chunk); !status.ok()) return status;
  if (absl::Status status = tallies_.Check(chunk); !status.ok()) return status;
  next_index_ += chunk.count;
  if (chunk.summary.has_value() != (next_index_ == *end_index_)) {
    return absl::DataLossError(absl::StrCat("the sweep's summary is ", chunk.summary.has_value() ? "early" : "missing",
                                            " at point ", next_index_, " of ", *end_index_));
  }
  summarised_ = chunk.summary.has_value();
  return absl::OkStatus();
}

absl::Status ChunkChecker::CheckEngine(const SweepChunk& chunk) {
  if (!engine_.has_value()) engine_ = chunk.engine.fingerprint;
  if (chunk.engine.fingerprint == *engine_) return absl::OkStatus();
  if (tallies_.counted().points == 0) return OtherEngine(next_index_, chunk.engine.fingerprint, *engine_);
  return absl::DataLossError(EnginesDiffer(next_index_, chunk.engine.fingerprint, *engine_));
}

absl::Status ChunkChecker::CheckSize(const SweepChunk& chunk) {
  if (chunk.first_index != next_index_) {
    return absl::DataLossError(absl::StrCat("the sweep's next chunk should start at point ", next_index_,
                                            " but starts at ", chunk.first_index));
  }
  if (!end_index_.has_value()) {
    if (chunk.points_total > std::numeric_limits<int64_t>::max() - std::max<int64_t>(next_index_, 0)) {
      return absl::DataLossError(absl::StrCat("the sweep's chunk at point ", next_index_, " promises ",
                                              chunk.points_total, " points, more than can be numbered"));
    }
    end_index_ = next_index_ + std::max<int64_t>(chunk.points_total, 0);
  }
  // This divides, because a hostile count times the number of columns may overflow.
  const auto values = static_cast<int64_t>(chunk.values.size());
  const bool fits = chunk.count >= 0 && static_cast<uint64_t>(chunk.count) <= PointsLeft(next_index_, *end_index_) &&
                    (columns_ == 0 ? values == 0 : values % columns_ == 0 && values / columns_ == chunk.count);
  if (!fits) {
    return absl::DataLossError(absl::StrCat("the sweep's chunk at point ", next_index_, " has ", values, " values for ",
                                            chunk.count, " points of ", columns_, " columns, in a range that ends at ",
                                            *end_index_));
  }
  const size_t wanted = with_regime_ ? static_cast<size_t>(chunk.count) : 0;
  if (chunk.regimes.size() != wanted || chunk.statuses.size() != wanted) {
    return absl::DataLossError(absl::StrCat("the sweep's chunk at point ", next_index_, " has ", chunk.regimes.size(),
                                            " regimes and ", chunk.statuses.size(), " statuses instead of ", wanted));
  }
  return absl::OkStatus();
}

absl::Status ChunkChecker::CheckEnd() const {
  if (summarised_) return absl::OkStatus();
  return absl::DataLossError(absl::StrCat("the sweep ended at point ", next_index_, " of ",
                                          end_index_.has_value() ? absl::StrCat(*end_index_) : "?"));
}

}  // namespace ricochet
