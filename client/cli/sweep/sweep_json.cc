#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/cli/sweep/sweep_file.h"
#include "client/cli/sweep/sweep_rows.h"
#include "core/base/try.h"

namespace ricochet::cli {
namespace {

using Json = nlohmann::ordered_json;

// JSON has no number for NaN, which is null, nor for the infinities.
std::optional<double> NumberOf(const Json& cell) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (cell.is_number()) return cell.get<double>();
  if (cell.is_null()) return std::numeric_limits<double>::quiet_NaN();
  if (cell == "Infinity") return kInfinity;
  if (cell == "-Infinity") return -kInfinity;
  return std::nullopt;
}

absl::Status AddCell(const Json& cell, size_t place, const std::string& name, SweepRows& rows) {
  if (rows.KindOf(place) == SweepRows::Kind::kSkipped) return absl::OkStatus();
  if (rows.KindOf(place) != SweepRows::Kind::kNumber) {
    return rows.AddName(place, cell.is_string() ? cell.get<std::string>() : cell.dump());
  }
  const std::optional<double> number = NumberOf(cell);
  if (!number.has_value()) {
    return absl::InvalidArgumentError(absl::StrCat(name, " = ", cell.dump(), ": must be a number or null"));
  }
  rows.AddNumber(place, *number);
  return absl::OkStatus();
}

// Makes rows of JSON values: the cells of a point, by their names or by their places.
class Points {
 public:
  explicit Points(std::vector<std::string> wanted) : wanted_(std::move(wanted)) {}

  absl::Status SetNames(std::vector<std::string> names) {
    RICOCHET_TRY(SweepRows rows, SweepRows::Create(names, wanted_));
    names_ = std::move(names);
    rows_ = std::move(rows);
    return absl::OkStatus();
  }

  bool has_names() const { return rows_.has_value(); }
  int64_t count() const { return count_; }

  // `point` is a list, or an object with the names in their order.
  absl::Status Add(const Json& point) {
    if (++count_ > SweepTable::kMostPoints) return TooManyPoints();
    if (point.size() != names_.size()) {
      return absl::InvalidArgumentError(absl::StrCat("has ", point.size(), " cells: must have ", names_.size()));
    }
    size_t place = 0;
    for (const auto& [key, cell] : point.items()) {
      if (point.is_object() && key != names_[place]) {
        return absl::InvalidArgumentError(absl::StrCat("has the name ", key, " in place of ", names_[place]));
      }
      if (absl::Status status = AddCell(cell, place, names_[place], *rows_); !status.ok()) return status;
      ++place;
    }
    return absl::OkStatus();
  }

  SweepTable& table() { return rows_->table(); }

 private:
  std::vector<std::string> wanted_;
  std::vector<std::string> names_;
  std::optional<SweepRows> rows_;
  int64_t count_ = 0;
};

// Adds which point an error is of. Too many points is an error of all.
absl::Status Located(const absl::Status& status, const char* unit, int64_t number) {
  if (status.code() != absl::StatusCode::kInvalidArgument) return status;
  return absl::InvalidArgumentError(absl::StrCat(unit, " ", number, ": ", status.message()));
}

absl::StatusOr<SweepTable> ReadLines(std::istream& stream, const std::vector<std::string>& wanted) {
  Points points(wanted);
  std::string line;
  for (int64_t number = 1; std::getline(stream, line); ++number) {
    const Json point = Json::parse(line, nullptr, /*allow_exceptions=*/false);
    if (!point.is_object()) return absl::InvalidArgumentError(absl::StrCat("line ", number, ": must be a JSON object"));
    if (!points.has_names()) {
      std::vector<std::string> names;
      for (const auto& item : point.items()) names.push_back(item.key());
      if (absl::Status status = points.SetNames(std::move(names)); !status.ok()) return status;
    }
    if (absl::Status status = points.Add(point); !status.ok()) return Located(status, "line", number);
  }
  return std::move(points.table());
}

absl::StatusOr<std::vector<std::string>> NamesOf(const Json& columns) {
  std::vector<std::string> names;
  for (const Json& column : columns) {
    const auto name = column.is_object() ? column.find("name") : column.end();
    if (!column.is_object() || name == column.end() || !name->is_string()) {
      return absl::InvalidArgumentError("columns must be a list of objects with a name");
    }
    names.push_back(name->get<std::string>());
  }
  return names;
}

// Each point is taken when it has been read and then dropped, so that the document is never in memory as a whole.
absl::StatusOr<SweepTable> ReadDocument(std::istream& stream, const std::vector<std::string>& wanted) {
  Points points(wanted);
  absl::Status status;
  std::string key;
  const auto take = [&](int depth, Json::parse_event_t event, Json& part) {
    if (event == Json::parse_event_t::key && depth == 1) key = part.get<std::string>();
    if (event != Json::parse_event_t::array_end || !status.ok()) return true;
    if (depth == 1 && key == "columns") {
      absl::StatusOr<std::vector<std::string>> names = NamesOf(part);
      status = names.ok() ? points.SetNames(*std::move(names)) : names.status();
    }
    if (depth != 2 || key != "values") return true;
    if (!points.has_names()) {
      status = absl::InvalidArgumentError("the columns must stand before the values");
    } else {
      // Points are counted from 0, as the index of a sweep is.
      const int64_t number = points.count();
      status = Located(points.Add(part), "point", number);
    }
    return false;
  };
  const Json document = Json::parse(stream, take, /*allow_exceptions=*/false);
  if (!status.ok()) return status;
  if (document.is_discarded()) return absl::InvalidArgumentError("is not a whole JSON document");
  if (!points.has_names()) return absl::InvalidArgumentError("has no columns, so ricochet sweep did not write it");
  return std::move(points.table());
}

}  // namespace

absl::StatusOr<SweepTable> ReadSweepJson(std::istream& stream, const std::vector<std::string>& columns) {
  std::string line;
  std::getline(stream, line);
  stream.clear();
  stream.seekg(0);
  const Json first = Json::parse(line, nullptr, /*allow_exceptions=*/false);
  return first.is_object() && first.contains("index") ? ReadLines(stream, columns) : ReadDocument(stream, columns);
}

}  // namespace ricochet::cli
