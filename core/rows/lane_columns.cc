#include "core/rows/lane_columns.h"

#include <algorithm>
#include <limits>
#include <string>

#include "absl/strings/match.h"
#include "absl/strings/string_view.h"

namespace ricochet {

static constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Returns the place of the number that the field at `path` sets. All definitions of restitution share one place.
static size_t NumberAt(absl::string_view path, const std::vector<std::string>& paths) {
  if (absl::StartsWith(path, "restitution.")) return paths.size() - 1;
  return static_cast<size_t>(std::find(paths.begin(), paths.end(), path) - paths.begin());
}

LaneColumns::LaneColumns(const SceneLanes& lanes, DrivenScene& driven)
    : lanes_(lanes),
      driven_(driven),
      static_is_kinetic_(!driven.scene().friction.static_coefficient.has_value()),
      derived_of_(driven.fields().size()) {
  const SceneLanes::Numbers numbers = lanes_.NumbersOf(driven_.scene());
  for (size_t n = 0; n < numbers.size(); ++n) {
    numbers_[n].fill(numbers[n]);
    columns_.of[n] = numbers_[n].data();
    columns_.varies[n] = !lanes_.TakesFields();
  }
  if (!lanes_.TakesFields()) return;
  const std::vector<std::string> paths = SceneLanes::PathsOf(driven_.scene());
  static_ = paths.size() - 2;
  for (size_t k = 0; k < driven_.fields().size(); ++k) {
    std::vector<size_t>& set = numbers_of_.emplace_back();
    for (const std::string& path : driven_.fields()[k].sets()) set.push_back(NumberAt(path, paths));
  }
}

const SceneLanes::Columns& LaneColumns::Of(absl::Span<const FieldColumn> fields, size_t count) {
  if (!lanes_.TakesFields()) {
    SetFromScenes(fields, count);
    return columns_;
  }
  for (size_t k = 0; k < fields.size(); ++k) SetField(k, fields[k], count);
  if (static_is_kinetic_) {
    columns_.of[static_] = columns_.of[static_ - 1];
    columns_.varies[static_] = columns_.varies[static_ - 1];
  }
  return columns_;
}

void LaneColumns::SetField(size_t k, const FieldColumn& field, size_t count) {
  for (const size_t n : numbers_of_[k]) columns_.varies[n] = field.varies;
  if (numbers_of_[k].size() == 1) {
    columns_.of[numbers_of_[k][0]] = field.values;
  } else if (field.varies) {
    derived_of_[k].reset();
    for (size_t i = 0; i < count; ++i) SetDerived(k, field.values[i], i, 1);
  } else if (derived_of_[k] != field.values[0]) {
    derived_of_[k] = field.values[0];
    SetDerived(k, field.values[0], 0, SceneLanes::kBlock);
  }
}

// Writes the numbers of a derived field, or NaN if the field may not have the value.
void LaneColumns::SetDerived(size_t k, double value, size_t from, size_t count) {
  const bool is_good = driven_.Set(k, value);
  const SceneLanes::Numbers numbers = lanes_.NumbersOf(driven_.scene());
  for (const size_t n : numbers_of_[k]) std::fill_n(numbers_[n].data() + from, count, is_good ? numbers[n] : kNan);
}

// Fills the columns from scenes whose coefficients depend on the speed. Invalid rows get NaN, which no lanes take.
void LaneColumns::SetFromScenes(absl::Span<const FieldColumn> fields, size_t count) {
  for (size_t i = 0; i < count; ++i) {
    driven_.SetRow(fields, i);
    SceneLanes::Numbers numbers;
    numbers.fill(kNan);
    std::optional<SceneContact> contact;
    if (driven_.IsValid(contact)) numbers = lanes_.NumbersOf(driven_.scene());
    for (size_t n = 0; n < numbers.size(); ++n) numbers_[n][i] = numbers[n];
  }
}

}  // namespace ricochet
