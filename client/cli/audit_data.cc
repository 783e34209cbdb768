#include "client/cli/audit_data.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include "absl/strings/escaping.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/strip.h"
#include "client/cli/csv_table.h"
#include "client/cli/suggestion.h"

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

// The destination of a column of the file: a named column, or the rates of a link.
struct Place {
  std::vector<double> AuditColumns::*values = nullptr;
  std::optional<size_t> link;

  friend bool operator==(const Place&, const Place&) = default;
};
using Places = std::vector<std::optional<Place>>;  // Absent for a column that is left out.

size_t LinkCount(const Places& places) {
  return static_cast<size_t>(std::count_if(places.begin(), places.end(), [](const std::optional<Place>& place) {
    return place.has_value() && place->link.has_value();
  }));
}

std::optional<Place> PlaceOf(const std::string& cell) {
  for (const Named& known : kColumns) {
    if (cell == known.name) return Place{.values = known.values, .link = {}};
  }
  absl::string_view index = cell;
  uint32_t link = 0;
  if (absl::ConsumePrefix(&index, absl::StrCat(kRates, "[")) && absl::ConsumeSuffix(&index, "]") &&
      absl::SimpleAtoi(index, &link)) {
    return Place{.values = nullptr, .link = link};
  }
  return std::nullopt;
}

std::vector<std::string> KnownNames() {
  std::vector<std::string> known;
  for (const Named& column : kColumns) known.emplace_back(column.name);
  known.push_back(absl::StrCat(kRates, "[0]"));
  return known;
}

absl::Status UnknownColumn(const std::string& cell, const std::string& name) {
  const std::vector<std::string> known = KnownNames();
  return absl::InvalidArgumentError(absl::StrCat(name, " has the column \"", absl::CEscape(cell), "\": must be one of ",
                                                 absl::StrJoin(known, ", "), DidYouMean(cell, known),
                                                 "; --skip-column leaves a column out"));
}

absl::StatusOr<Places> PlacesOf(const std::vector<std::string>& cells, const std::string& name,
                                const std::vector<std::string>& skipped) {
  Places places;
  for (const std::string& column : skipped) {
    if (std::count(cells.begin(), cells.end(), column) > 0) continue;
    return absl::InvalidArgumentError(
        absl::StrCat("--skip-column = ", column, ": must be a column of ", name, DidYouMean(column, cells)));
  }
  for (const std::string& cell : cells) {
    if (std::count(skipped.begin(), skipped.end(), cell) > 0) {
      places.emplace_back();
      continue;
    }
    const std::optional<Place> place = PlaceOf(cell);
    if (!place.has_value()) return UnknownColumn(cell, name);
    if (std::count(places.begin(), places.end(), place) > 0) {
      return absl::InvalidArgumentError(absl::StrCat(name, " has the column ", cell, " twice"));
    }
    places.push_back(place);
  }
  const size_t links = LinkCount(places);
  for (const std::optional<Place>& place : places) {
    if (!place.has_value() || !place->link.has_value() || *place->link < links) continue;
    return absl::InvalidArgumentError(
        absl::StrCat(name, " has the column ", kRates, "[", *place->link, "] but not one for each link before it"));
  }
  return places;
}

std::vector<double>& ColumnAt(const Place& place, AuditColumns& columns) {
  return place.link.has_value() ? columns.rates_after_rad_s[*place.link] : columns.*place.values;
}

}  // namespace

absl::StatusOr<AuditColumns> ParseAuditData(const std::string& text, const std::string& name,
                                            const std::vector<std::string>& skipped) {
  absl::StatusOr<CsvTable> table = ParseCsvTable(text, name);
  if (!table.ok()) return table.status();
  const absl::StatusOr<Places> places = PlacesOf(table->header, name, skipped);
  if (!places.ok()) return places.status();
  AuditColumns columns;
  columns.rates_after_rad_s.resize(LinkCount(*places));
  for (size_t i = 0; i < places->size(); ++i) {
    const std::optional<Place>& place = (*places)[i];
    if (place.has_value()) ColumnAt(*place, columns) = std::move(table->columns[i]);
  }
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
