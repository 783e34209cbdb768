#include <algorithm>
#include <cstddef>
#include <utility>

#include "ricochet/batch.h"
#include "ricochet/sweep.h"

namespace ricochet {

// The sum is unsigned, because counts may come from a hostile message and must not overflow.
static int64_t Sum(int64_t a, int64_t b) {
  return static_cast<int64_t>(static_cast<uint64_t>(a) + static_cast<uint64_t>(b));
}

Tally Joined(const Tally& a, const Tally& b) {
  if (a.count == 0) return b;
  if (b.count == 0) return a;
  return {Sum(a.count, b.count), std::min(a.first_index, b.first_index)};
}

SweepSummary Joined(const SweepSummary& a, const SweepSummary& b) {
  SweepSummary joined = {.points = Sum(a.points, b.points),
                         .inadmissible = Joined(a.inadmissible, b.inadmissible),
                         .not_converged = Joined(a.not_converged, b.not_converged)};
  for (size_t i = 0; i < joined.by_regime.size(); ++i) joined.by_regime[i] = Joined(a.by_regime[i], b.by_regime[i]);
  for (size_t i = 0; i < joined.by_model.size(); ++i) joined.by_model[i] = Joined(a.by_model[i], b.by_model[i]);
  return joined;
}

BatchSummary Joined(BatchSummary first, BatchSummary second, int64_t first_row) {
  const auto shift = [first_row](Tally& tally) {
    if (tally.count > 0) tally.first_index += first_row;
  };
  for (Tally& tally : second.counts.by_regime) shift(tally);
  for (Tally& tally : second.counts.by_model) shift(tally);
  shift(second.counts.inadmissible);
  shift(second.counts.not_converged);
  first.counts = Joined(first.counts, second.counts);
  for (BadRow& bad : second.bad_rows) {
    if (first.bad_rows.size() == kMostBadRows) break;
    bad.row += first_row;
    first.bad_rows.push_back(std::move(bad));
  }
  return first;
}

}  // namespace ricochet
