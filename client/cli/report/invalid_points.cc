#include "client/cli/report/invalid_points.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/types/span.h"
#include "core/base/counted.h"
#include "core/plan/demand.h"
#include "core/plan/number_demand.h"
#include "core/rows/axis_values.h"
#include "core/rows/column.h"
#include "core/scene/field.h"
#include "core/scene/validate.h"
#include "core/types/grid.h"

namespace ricochet::cli {

InvalidPoints::InvalidPoints(const SweepRequest& request)
    : grid_(request.grid), demand_(WithNumbers(ToDemand(request.demand), request.columns)) {}

std::optional<Violation> InvalidPoints::First(int64_t index) {
  std::vector<int64_t> positions(grid_.axes.size());
  AxisPositions(grid_, index, absl::MakeSpan(positions));
  if (driven_ == nullptr) driven_ = std::make_shared<DrivenScene>(grid_.scene, AxisPaths(grid_));
  for (size_t i = 0; i < positions.size(); ++i) {
    const double value = AxisValue(grid_.axes[i], positions[i]);
    driven_->Set(i, value);
    if (grid_.axes[i].path != kPhi) continue;
    if (std::optional<Violation> violation = WhyNoPhi(value)) return violation;
  }
  std::optional<SceneContact> contact;
  std::vector<Violation> violations = Validate(driven_->scene(), RestitutionIs::kRequired, contact);
  if (violations.empty()) violations = CheckSolvableWithout(driven_->scene(), contact, demand_);
  if (violations.empty()) return std::nullopt;
  return std::move(violations.front());
}

bool InvalidPoints::KeepsRules(int64_t index) { return !First(index).has_value(); }

Violation InvalidPoints::WhyInvalid(int64_t index) {
  return First(index).value_or(MakeViolation("a column", "", "not exceed the largest double"));
}

std::string InvalidPoints::Reason(int64_t index) {
  const Violation first = WhyInvalid(index);
  return absl::StrCat(first.field, first.description[0] == ':' ? "" : " ", first.description);
}

std::string InvalidPoints::Rule(int64_t index) {
  const Violation first = WhyInvalid(index);
  return absl::StrCat(first.field, ": must ", first.rule);
}

DoubtfulPoints::DoubtfulPoints(const SweepRequest& request)
    : points_(request), may_lack_numbers_(std::all_of(request.columns.begin(), request.columns.end(), MayBeUnset)) {}

// True if the point has no numbers because it is invalid.
bool DoubtfulPoints::IsInvalid(const SweepChunk& chunk, int64_t i) {
  for (auto at = static_cast<size_t>(i); at < chunk.values.size(); at += static_cast<size_t>(chunk.count)) {
    if (!std::isnan(chunk.values[at])) return false;
  }
  return !may_lack_numbers_ || !points_.KeepsRules(chunk.first_index + i);
}

void DoubtfulPoints::Add(const SweepChunk& chunk) {
  for (int64_t i = 0; i < chunk.count; ++i) {
    if (count_ > kMostReasons || !IsInvalid(chunk, i) || ++count_ > kMostReasons) continue;
    const int64_t index = chunk.first_index + i;
    Tally& tally = by_rule_[points_.Rule(index)];
    if (tally.count++ == 0) tally.first_index = index;
  }
  if (chunk.summary.has_value()) summary_ = *chunk.summary;
}

std::string DoubtfulPoints::Text() const {
  std::string text;
  const auto add = [&text](const Tally& tally, absl::string_view verb, absl::string_view what) {
    if (tally.count == 0) return;
    absl::StrAppend(&text, Counted(tally.count, "point"), verb,
                    tally.count == 1 ? ", at index " : ", the first at index ", tally.first_index, what, "\n");
  };
  const int64_t invalid = summary_.by_regime[static_cast<size_t>(Regime::kInvalid)].count;
  if (invalid > 0) absl::StrAppend(&text, invalid, invalid == 1 ? " point is" : " points are", " invalid:\n");
  for (const auto& [rule, tally] : by_rule_) {
    text += "  ";
    add(tally, "", absl::StrCat(": ", rule));
  }
  const int64_t examined = std::min(count_, kMostReasons);
  if (examined < invalid) {
    absl::StrAppend(&text, invalid - examined,
                    count_ > kMostReasons ? " of them were not looked at for a reason: they are too many\n"
                                          : " of them come from an earlier run, whose reasons are not known\n");
  }
  add(summary_.inadmissible, summary_.inadmissible.count == 1 ? " is inadmissible" : " are inadmissible", "");
  add(summary_.not_converged, " did not converge",
      ": the impact has no end that is known, or the stated error exceeds the tolerance");
  return text;
}

absl::Status DoubtfulPoints::CheckStrictly() const {
  int64_t without_end = 0;
  for (size_t i = 0; i < summary_.by_regime.size(); ++i) {
    if (!HasEnd(static_cast<Regime>(i))) without_end += summary_.by_regime[i].count;
  }
  if (summary_.inadmissible.count + without_end == 0) return absl::OkStatus();
  return absl::FailedPreconditionError(absl::StrCat("of ", summary_.points, " points ", summary_.inadmissible.count,
                                                    " are inadmissible, and ", without_end,
                                                    " are invalid or have no end"));
}

}  // namespace ricochet::cli
