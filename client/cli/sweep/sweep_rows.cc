#include "client/cli/sweep/sweep_rows.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/cli/input/short_name.h"
#include "client/cli/text/enum_names.h"
#include "client/cli/text/field_table.h"
#include "core/base/derivative_name.h"
#include "core/base/nearest.h"
#include "core/base/try.h"

namespace ricochet::cli {
namespace {

bool IsOf(const std::vector<FieldInfo>& table, const FieldInfo* info) {
  return info >= &table.front() && info <= &table.back();
}

size_t PlaceOf(const std::string& name, const std::vector<std::string>& names) {
  return static_cast<size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

// Axes come before columns.
absl::Status Sort(const std::vector<std::string>& names, std::vector<std::string>& axes,
                  std::vector<std::string>& columns) {
  if (names.empty() || names.front() != "index") {
    return absl::InvalidArgumentError("the first column must be index, as in every table that ricochet sweep writes");
  }
  std::set<std::string> seen;
  for (size_t i = 1; i < names.size(); ++i) {
    if (!seen.insert(names[i]).second) {
      return absl::InvalidArgumentError(absl::StrCat("the column ", names[i], " is there twice"));
    }
    if (names[i] == "regime" || names[i] == "status") continue;
    const std::optional<DerivativeName> derivative = ReadDerivativeName(names[i]);
    const FieldInfo* const info = FindFieldInfo(derivative.has_value() ? derivative->of : names[i]);
    if (info == nullptr || (derivative.has_value() && FindFieldInfo(derivative->by) == nullptr)) {
      return absl::InvalidArgumentError(
          absl::StrCat("the column ", names[i], " must be a field of a scene or an outcome"));
    }
    (IsOf(SceneFieldTable(), info) ? axes : columns).push_back(names[i]);
  }
  if (!columns.empty()) return absl::OkStatus();
  return absl::InvalidArgumentError("there is no column of an outcome, such as coefficients.newton");
}

}  // namespace

absl::Status TooManyPoints() {
  return absl::FailedPreconditionError(
      absl::StrCat("has more points than a picture can show (", SweepTable::kMostPoints, ")"));
}

absl::StatusOr<std::vector<std::string>> ChooseColumns(const std::vector<std::string>& columns,
                                                       const std::vector<std::string>& wanted) {
  RICOCHET_TRY(std::vector<std::string> chosen, FullColumns(columns, columns, wanted));
  std::set<std::string> seen;
  for (const std::string& name : chosen) {
    if (PlaceOf(name, columns) == columns.size()) {
      return absl::InvalidArgumentError(absl::StrCat("--column ", name, ": must be a column of the file",
                                                     DidYouMean(name, columns),
                                                     "\nColumns: ", absl::StrJoin(columns, ", ")));
    }
    if (!seen.insert(name).second) {
      return absl::InvalidArgumentError(absl::StrCat("--column ", name, ": must be named once"));
    }
  }
  return chosen.empty() ? columns : std::move(chosen);
}

absl::StatusOr<SweepRows> SweepRows::Create(const std::vector<std::string>& names,
                                            const std::vector<std::string>& wanted) {
  SweepRows rows;
  SweepTable& table = rows.table_;
  std::vector<std::string> columns;
  if (absl::Status status = Sort(names, table.axes, columns); !status.ok()) return status;
  RICOCHET_TRY(table.columns, ChooseColumns(columns, wanted));
  table.at.resize(table.axes.size());
  table.values.resize(table.columns.size());
  for (const std::string& name : names) {
    const size_t axis = PlaceOf(name, table.axes);
    const size_t column = PlaceOf(name, table.columns);
    const bool is_axis = axis < table.axes.size();
    const bool is_number = is_axis || column < table.columns.size();
    rows.kinds_.push_back(name == "regime"               ? Kind::kRegime
                          : name == "status"             ? Kind::kStatus
                          : is_number || name == "index" ? Kind::kNumber
                                                         : Kind::kSkipped);
    rows.places_.push_back(is_axis ? axis : table.axes.size() + column);
  }
  return rows;
}

void SweepRows::AddNumber(size_t cell, double value) {
  if (cell == 0) return table_.index.push_back(value);
  const size_t place = places_[cell];
  const size_t axes = table_.axes.size();
  (place < axes ? table_.at[place] : table_.values[place - axes]).push_back(value);
}

absl::Status SweepRows::AddName(size_t cell, const std::string& name) {
  if (KindOf(cell) == Kind::kRegime) {
    for (int i = 0; i < kRegimeCount; ++i) {
      if (name == RegimeName(static_cast<Regime>(i))) return AddCode(cell, i);
    }
    return absl::InvalidArgumentError(
        absl::StrCat("regime = ", name, ": must be the name of a regime, such as REBOUND"));
  }
  const std::string kind = name.substr(0, name.find(':'));
  for (int i = 0; i < kRowStatusCount; ++i) {
    if (kind == StatusName(static_cast<RowStatus>(i))) return AddCode(cell, i);
  }
  return absl::InvalidArgumentError(absl::StrCat("status = ", name, ": must be the name of a status, such as OK"));
}

absl::Status SweepRows::AddCode(size_t cell, int64_t number) {
  const bool is_regime = KindOf(cell) == Kind::kRegime;
  const int count = is_regime ? kRegimeCount : kRowStatusCount;
  if (number < 0 || number >= count) {
    const char* const name = is_regime ? "regime" : "status";
    return absl::InvalidArgumentError(
        absl::StrCat(name, " = ", number, ": must be the number of a ", name, ", from 0 to ", count - 1));
  }
  if (is_regime) {
    table_.regimes.push_back(static_cast<Regime>(number));
  } else {
    table_.statuses.push_back(static_cast<RowStatus>(number));
  }
  return absl::OkStatus();
}

}  // namespace ricochet::cli
