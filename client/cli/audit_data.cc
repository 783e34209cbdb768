#include "client/cli/audit_data.h"

#include <algorithm>
#include <limits>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "client/cli/number_input.h"

namespace ricochet::cli {
namespace {

struct Named {
  const char* name;
  std::vector<double> AuditColumns::*values;
};

constexpr Named kColumns[] = {{"tangential_m_s", &AuditColumns::tangential_m_s},
                              {"tangential_2_m_s", &AuditColumns::tangential_2_m_s},
                              {"normal_m_s", &AuditColumns::normal_m_s},
                              {"tangential_after_m_s", &AuditColumns::tangential_after_m_s},
                              {"tangential_2_after_m_s", &AuditColumns::tangential_2_after_m_s},
                              {"normal_after_m_s", &AuditColumns::normal_after_m_s},
                              {"friction", &AuditColumns::friction},
                              {"velocity_uncertainty_m_s", &AuditColumns::velocity_uncertainty_m_s}};

// Where each column of a file goes; null: nowhere.
using Places = std::vector<std::vector<double> AuditColumns::*>;

std::vector<std::string> Cells(const std::string& line) {
  std::vector<std::string> cells = absl::StrSplit(line, ',');
  for (std::string& cell : cells) absl::StripAsciiWhitespace(&cell);
  return cells;
}

absl::StatusOr<Places> ParseHeader(const std::string& line, const std::string& name) {
  Places places;
  for (const std::string& cell : Cells(line)) {
    const auto* found =
        std::find_if(std::begin(kColumns), std::end(kColumns), [&](const Named& known) { return cell == known.name; });
    places.push_back(found == std::end(kColumns) ? nullptr : found->values);
    if (places.back() != nullptr && std::count(places.begin(), places.end(), places.back()) > 1) {
      return absl::InvalidArgumentError(absl::StrCat(name, " has the column ", cell, " twice"));
    }
  }
  if (std::all_of(places.begin(), places.end(), [](const auto& place) { return place == nullptr; })) {
    std::string known;
    for (const Named& column : kColumns) absl::StrAppend(&known, known.empty() ? "" : ", ", column.name);
    return absl::InvalidArgumentError(
        absl::StrCat(name, " names no known column in its first line: must name some of ", known));
  }
  return places;
}

void AddRow(const std::vector<std::string>& cells, const Places& places, AuditColumns& columns) {
  for (size_t i = 0; i < places.size(); ++i) {
    if (places[i] == nullptr) continue;
    const absl::StatusOr<double> value = ParseNumber(i < cells.size() ? cells[i] : "", "");
    (columns.*places[i]).push_back(value.ok() ? *value : std::numeric_limits<double>::quiet_NaN());
  }
}

}  // namespace

absl::StatusOr<AuditColumns> ParseAuditData(const std::string& text, const std::string& name) {
  absl::StatusOr<Places> places = absl::InvalidArgumentError(absl::StrCat(name, " has no header"));
  AuditColumns columns;
  for (const auto line_view : absl::StrSplit(text, '\n')) {
    const std::string line(absl::StripAsciiWhitespace(line_view));
    if (line.empty() || line[0] == '#') continue;
    if (places.ok()) {
      AddRow(Cells(line), *places, columns);
    } else {
      places = ParseHeader(line, name);
      if (!places.ok()) return places.status();
    }
  }
  if (!places.ok()) return places.status();
  return columns;
}

AuditColumns SomeRows(const AuditColumns& columns, size_t first, size_t end) {
  AuditColumns some;
  for (const Named& column : kColumns) {
    const std::vector<double>& all = columns.*column.values;
    if (all.empty()) continue;
    some.*column.values = {all.begin() + static_cast<ptrdiff_t>(first), all.begin() + static_cast<ptrdiff_t>(end)};
  }
  return some;
}

size_t RowCount(const AuditColumns& columns) {
  size_t rows = 0;
  for (const Named& column : kColumns) rows = std::max(rows, (columns.*column.values).size());
  return rows;
}

}  // namespace ricochet::cli
