#include "client/tally_checker.h"

#include <array>
#include <cstddef>
#include <cstdint>

#include "absl/strings/str_cat.h"

namespace ricochet {
namespace {

// True if `after` may be what `before` becomes with the points of `chunk`.
bool Grows(const Tally& before, const Tally& after, const SweepChunk& chunk) {
  if (after.count < before.count || after.count - before.count > chunk.count) return false;
  if (before.count > 0 || after.count == 0) return after.first_index == before.first_index;
  return after.first_index >= chunk.first_index && after.first_index - chunk.first_index < chunk.count;
}

// True if the tallies together grew by `points`.
template <size_t kKinds>
bool GrowBy(int64_t points, const std::array<Tally, kKinds>& before, const std::array<Tally, kKinds>& after,
            const SweepChunk& chunk) {
  for (size_t kind = 0; kind < kKinds; ++kind) {
    if (!Grows(before[kind], after[kind], chunk)) return false;
    points -= after[kind].count - before[kind].count;
    if (points < 0) return false;
  }
  return points == 0;
}

// True if the chunk has no regimes, or if `after` counts them and the statuses.
bool CountsRegimes(const SweepSummary& before, const SweepSummary& after, const SweepChunk& chunk) {
  if (chunk.regimes.empty()) return true;
  std::array<Tally, kRegimeCount> by_regime = before.by_regime;
  Tally inadmissible = before.inadmissible, not_converged = before.not_converged;
  for (size_t i = 0; i < chunk.regimes.size(); ++i) {
    const Tally point = {1, chunk.first_index + static_cast<int64_t>(i)};
    Tally& tally = by_regime[static_cast<size_t>(chunk.regimes[i])];
    tally = Joined(tally, point);
    if (chunk.statuses[i] == RowStatus::kInadmissible) inadmissible = Joined(inadmissible, point);
    if (chunk.statuses[i] == RowStatus::kNotConverged) not_converged = Joined(not_converged, point);
  }
  return by_regime == after.by_regime && inadmissible == after.inadmissible && not_converged == after.not_converged;
}

bool Counts(const SweepSummary& before, const SweepChunk& chunk) {
  constexpr auto kInvalid = static_cast<size_t>(Regime::kInvalid);
  const SweepSummary& after = chunk.tallies;
  if (after.points < before.points || after.points - before.points != chunk.count) return false;
  if (!GrowBy(chunk.count, before.by_regime, after.by_regime, chunk)) return false;
  const int64_t valid = chunk.count - (after.by_regime[kInvalid].count - before.by_regime[kInvalid].count);
  return GrowBy(valid, before.by_model, after.by_model, chunk) &&
         Grows(before.inadmissible, after.inadmissible, chunk) &&
         Grows(before.not_converged, after.not_converged, chunk) && CountsRegimes(before, after, chunk);
}

}  // namespace

absl::Status TallyChecker::Check(const SweepChunk& chunk) {
  if (!Counts(counted_, chunk)) {
    return absl::DataLossError(absl::StrCat("the tallies of the sweep's chunk at point ", chunk.first_index,
                                            " do not count its ", chunk.count, " points"));
  }
  if (chunk.summary.has_value()) {
    SweepSummary summary = *chunk.summary;
    summary.elapsed_s = chunk.tallies.elapsed_s;
    if (summary != chunk.tallies) return absl::DataLossError("the sweep's summary differs from its tallies");
  }
  counted_ = chunk.tallies;
  return absl::OkStatus();
}

}  // namespace ricochet
