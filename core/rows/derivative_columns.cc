#include "core/rows/derivative_columns.h"

#include <algorithm>
#include <limits>

#include "absl/status/statusor.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "core/answer/derivative_paths.h"
#include "core/answer/derivatives.h"
#include "ricochet/error.h"

namespace ricochet {
namespace {

// The place of `path` among `paths`, to which it is added if it is new.
size_t PlaceOf(const std::string& path, std::vector<std::string>& paths) {
  const auto found = std::find(paths.begin(), paths.end(), path);
  const auto place = static_cast<size_t>(found - paths.begin());
  if (found == paths.end()) paths.push_back(path);
  return place;
}

}  // namespace

std::string RuleForDerivative(const Scene& scene, const DerivativeName& name) {
  const auto violations = CheckDerivatives(scene, {}, {.of = {name.of}, .by = {name.by}});
  if (violations.empty()) return "";
  const Violation& first = violations.front();
  const bool is_of = absl::StartsWith(first.field, "derivatives.of");
  return absl::StrCat("have in its ", is_of ? "first" : "second", " d() ", absl::StripPrefix(first.rule, "be "));
}

DerivativeColumns::DerivativeColumns(absl::Span<const std::string> columns) {
  for (size_t c = 0; c < columns.size(); ++c) {
    const std::optional<DerivativeName> name = ReadDerivativeName(columns[c]);
    if (!name.has_value()) continue;
    asked_.push_back({.column = c, .of = PlaceOf(name->of, paths_.of), .by = PlaceOf(name->by, paths_.by)});
  }
}

std::vector<size_t> DerivativeColumns::Others(size_t count) const {
  std::vector<size_t> others;
  for (size_t column = 0, next = 0; column < count; ++column) {
    const bool is_derivative = next < asked_.size() && asked_[next].column == column;
    if (is_derivative) ++next;
    if (!is_derivative) others.push_back(column);
  }
  return others;
}

absl::Status DerivativeColumns::Set(const Scene& scene, const Demand& demand, absl::FunctionRef<bool()> stopped,
                                    absl::Span<double* const> columns, size_t i, bool& is_complete) {
  const bool is_exact = WhyNotExact(scene) == nullptr;
  absl::StatusOr<std::vector<Derivative>> derivatives;
  if (is_exact) {
    if (!exact_.has_value()) exact_.emplace(scene, paths_);
    exact_->Compute(scene);
  } else {
    derivatives = DerivativesOf(scene, demand, paths_, stopped);
    if (!derivatives.ok()) return derivatives.status();
  }
  is_complete = true;
  for (const auto& [column, of, by] : asked_) {
    const std::optional<double> value =
        is_exact ? exact_->At(of, by).value : (*derivatives)[of * paths_.by.size() + by].value;
    is_complete &= value.has_value();
    columns[column][i] = value.value_or(std::numeric_limits<double>::quiet_NaN());
  }
  return absl::OkStatus();
}

}  // namespace ricochet
