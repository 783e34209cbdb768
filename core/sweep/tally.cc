#include <algorithm>
#include <cstddef>

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
  SweepSummary joined = {.points = Sum(a.points, b.points), .inadmissible = Joined(a.inadmissible, b.inadmissible)};
  for (size_t i = 0; i < joined.by_regime.size(); ++i) joined.by_regime[i] = Joined(a.by_regime[i], b.by_regime[i]);
  for (size_t i = 0; i < joined.by_model.size(); ++i) joined.by_model[i] = Joined(a.by_model[i], b.by_model[i]);
  return joined;
}

}  // namespace ricochet
