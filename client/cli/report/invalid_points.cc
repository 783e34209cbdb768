#include "client/cli/report/invalid_points.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/types/span.h"
#include "core/plan/demand_fields.h"
#include "core/plan/number_demand.h"
#include "core/rows/axis_values.h"
#include "core/rows/column.h"
#include "core/scene/check.h"
#include "core/scene/numbers.h"
#include "core/scene/validate.h"
#include "core/types/grid.h"

namespace ricochet::cli {
namespace {

// The one field that an axis drives although no scene has it, so that checking the scene does not check it.
constexpr NumberPath kPhi = {.prefix = "pendulum", .name = "phi_rad"};

}  // namespace

InvalidPoints::InvalidPoints(const SweepRequest& request)
    : grid_(request.grid), demand_(WithNumbers(ToDemand(request.demand), request.columns)) {}

std::optional<Violation> InvalidPoints::First(int64_t index) {
  std::vector<int64_t> positions(grid_.axes.size());
  AxisPositions(grid_, index, absl::MakeSpan(positions));
  if (driven_ == nullptr) driven_ = std::make_shared<DrivenScene>(grid_.scene, AxisPaths(grid_));
  for (size_t i = 0; i < positions.size(); ++i) {
    const double value = AxisValue(grid_.axes[i], positions[i]);
    driven_->Set(i, value);
    if (grid_.axes[i].path != kPhi.Text()) continue;
    Check check(Check::Mode::kListing);
    check.Number(kPhi, value, NumberRule::kHalfTurn);
    if (check.failed()) return std::move(check).violations().front();
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

InvalidCounts::InvalidCounts(const SweepRequest& request)
    : points_(request), may_lack_numbers_(std::all_of(request.columns.begin(), request.columns.end(), MayBeUnset)) {}

// True if the point has no numbers because it is invalid.
bool InvalidCounts::IsInvalid(const SweepChunk& chunk, int64_t i) {
  for (auto at = static_cast<size_t>(i); at < chunk.values.size(); at += static_cast<size_t>(chunk.count)) {
    if (!std::isnan(chunk.values[at])) return false;
  }
  return !may_lack_numbers_ || !points_.KeepsRules(chunk.first_index + i);
}

void InvalidCounts::Add(const SweepChunk& chunk) {
  for (int64_t i = 0; i < chunk.count; ++i) {
    if (count_ > kMostReasons || !IsInvalid(chunk, i) || ++count_ > kMostReasons) continue;
    const int64_t index = chunk.first_index + i;
    Tally& tally = by_rule_[points_.Rule(index)];
    if (tally.count++ == 0) tally.first_index = index;
  }
  if (chunk.summary.has_value()) total_ = chunk.summary->by_regime[static_cast<size_t>(Regime::kInvalid)].count;
}

std::string InvalidCounts::Text() const {
  if (total_ == 0) return "";
  std::string text = absl::StrCat(total_, total_ == 1 ? " point is" : " points are", " invalid");
  const int64_t known = std::min(count_, kMostReasons);
  if (known < total_) absl::StrAppend(&text, "; the reasons of ", known, " of them");
  absl::StrAppend(&text, ":\n");
  for (const auto& [rule, tally] : by_rule_) {
    absl::StrAppend(&text, "  ", tally.count, tally.count == 1 ? " point, at index " : " points, the first at index ",
                    tally.first_index, ": ", rule, "\n");
  }
  return text;
}

}  // namespace ricochet::cli
