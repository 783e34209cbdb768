#include "client/cli/audit_data.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

#include "absl/strings/ascii.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
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

constexpr char kRates[] = "rates_after_rad_s";

// The destination of a column of the file: a named column, the rates of a link, or neither if its name is unknown.
struct Place {
  std::vector<double> AuditColumns::*values = nullptr;
  std::optional<size_t> link;

  bool known() const { return values != nullptr || link.has_value(); }
  friend bool operator==(const Place&, const Place&) = default;
};
using Places = std::vector<Place>;

size_t LinkCount(const Places& places) {
  return static_cast<size_t>(
      std::count_if(places.begin(), places.end(), [](const Place& place) { return place.link.has_value(); }));
}

std::vector<std::string> Cells(const std::string& line) {
  std::vector<std::string> cells = absl::StrSplit(line, ',');
  for (std::string& cell : cells) absl::StripAsciiWhitespace(&cell);
  return cells;
}

Place PlaceOf(const std::string& cell) {
  for (const Named& known : kColumns) {
    if (cell == known.name) return {.values = known.values, .link = {}};
  }
  absl::string_view index = cell;
  uint32_t link = 0;
  if (absl::ConsumePrefix(&index, absl::StrCat(kRates, "[")) && absl::ConsumeSuffix(&index, "]") &&
      absl::SimpleAtoi(index, &link)) {
    return {.values = nullptr, .link = link};
  }
  return {};
}

std::string KnownNames() {
  std::string known;
  for (const Named& column : kColumns) absl::StrAppend(&known, column.name, ", ");
  return absl::StrCat(known, kRates, "[0]");
}

absl::StatusOr<Places> ParseHeader(const std::string& line, const std::string& name) {
  Places places;
  for (const std::string& cell : Cells(line)) {
    places.push_back(PlaceOf(cell));
    if (places.back().known() && std::count(places.begin(), places.end(), places.back()) > 1) {
      return absl::InvalidArgumentError(absl::StrCat(name, " has the column ", cell, " twice"));
    }
  }
  if (std::none_of(places.begin(), places.end(), [](const Place& place) { return place.known(); })) {
    return absl::InvalidArgumentError(
        absl::StrCat(name, " names no known column in its first line: must name some of ", KnownNames()));
  }
  const size_t links = LinkCount(places);
  for (const Place& place : places) {
    if (!place.link.has_value() || *place.link < links) continue;
    return absl::InvalidArgumentError(
        absl::StrCat(name, " has the column ", kRates, "[", *place.link, "] but not one for each link before it"));
  }
  return places;
}

std::vector<double>& ColumnAt(const Place& place, AuditColumns& columns) {
  return place.link.has_value() ? columns.rates_after_rad_s[*place.link] : columns.*place.values;
}

void AddRow(const std::vector<std::string>& cells, const Places& places, AuditColumns& columns) {
  for (size_t i = 0; i < places.size(); ++i) {
    if (!places[i].known()) continue;
    const absl::StatusOr<double> value = ParseNumber(i < cells.size() ? cells[i] : "", "");
    ColumnAt(places[i], columns).push_back(value.ok() ? *value : std::numeric_limits<double>::quiet_NaN());
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
      columns.rates_after_rad_s.resize(LinkCount(*places));
    }
  }
  if (!places.ok()) return places.status();
  return columns;
}

AuditColumns SomeRows(const AuditColumns& columns, size_t first, size_t end) {
  const auto some_of = [first, end](const std::vector<double>& all) {
    if (all.empty()) return all;
    return std::vector<double>(all.begin() + static_cast<ptrdiff_t>(first), all.begin() + static_cast<ptrdiff_t>(end));
  };
  AuditColumns some;
  for (const Named& column : kColumns) some.*column.values = some_of(columns.*column.values);
  for (const std::vector<double>& rates : columns.rates_after_rad_s) some.rates_after_rad_s.push_back(some_of(rates));
  return some;
}

size_t RowCount(const AuditColumns& columns) {
  size_t rows = 0;
  for (const Named& column : kColumns) rows = std::max(rows, (columns.*column.values).size());
  for (const std::vector<double>& rates : columns.rates_after_rad_s) rows = std::max(rows, rates.size());
  return rows;
}

}  // namespace ricochet::cli
