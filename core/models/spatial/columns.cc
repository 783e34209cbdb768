// This file is compiled once for each SIMD target (foreach_target.h includes it again). The target is chosen at run
// time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/models/spatial/columns.cc"
#include "core/models/spatial/columns.h"

#include <algorithm>
#include <cassert>

// Highway prescribes the order of these includes.
// clang-format off
#include "hwy/foreach_target.h"
#include "core/models/spatial/lane_group-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace ricochet::spatial::HWY_NAMESPACE {

// Impacts whose steps are alike step together.
void SolveAll(absl::Span<const Problem> problems, absl::Span<Impact> impacts) {
#if RICOCHET_SIMD
  for (const int order : {8, 9, 11, 14, 17, 20, kMaxOrder}) {
    for (const bool may_jam : {false, true}) {
      const StepGroup group = {order, may_jam};
      const auto is_in_group = [&group](const Problem& problem) { return group.Has(problem); };
      if (std::any_of(problems.begin(), problems.end(), is_in_group)) LaneGroup(group, problems, impacts).Run();
    }
  }
#else
  std::transform(problems.begin(), problems.end(), impacts.begin(), Solve);
#endif
}

}  // namespace ricochet::spatial::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace ricochet::spatial {

HWY_EXPORT(SolveAll);

void SolveColumns(absl::Span<const Problem> problems, absl::Span<Impact> impacts) {
  assert(problems.size() == impacts.size());
  HWY_DYNAMIC_DISPATCH(SolveAll)(problems, impacts);
}

}  // namespace ricochet::spatial

#endif  // HWY_ONCE
