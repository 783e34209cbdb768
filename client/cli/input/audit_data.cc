#include "client/cli/input/audit_data.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "absl/strings/escaping.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/strip.h"
#include "client/cli/input/short_name.h"
#include "core/base/decimal.h"
#include "core/base/nearest.h"
#include "ricochet/audit_columns.h"

namespace ricochet::cli {
namespace {

constexpr char kRates[] = "rates_after_rad_s";

std::vector<std::string> KnownNames() {
  std::vector<std::string> known;
  for (const NamedAuditColumn& column : kAuditColumns) known.emplace_back(column.name);
  known.push_back(absl::StrCat(kRates, "[0]"));
  return known;
}

absl::Status UnknownColumn(const std::string& cell, const std::string& name) {
  const std::vector<std::string> known = KnownNames();
  return absl::InvalidArgumentError(absl::StrCat(name, " has the column \"", absl::CEscape(cell), "\": must be one of ",
                                                 absl::StrJoin(known, ", "), DidYouMean(cell, known),
                                                 "; --skip-column leaves a column out"));
}

// Returns why a value is not finite or below `least`; empty if neither is so.
std::string WhyWrong(absl::string_view name, const std::vector<double>& column, size_t row, double least) {
  if (column.empty() || (std::isfinite(column[row]) && column[row] >= least)) return "";
  return absl::StrCat(name, " = ", ShortestDecimal(column[row]), ": must be ",
                      std::isfinite(column[row]) ? absl::StrCat(">= ", least) : "finite");
}

}  // namespace

size_t AuditTable::LinkCount(const Places& places) {
  return static_cast<size_t>(std::count_if(places.begin(), places.end(), [](const std::optional<Place>& place) {
    return place.has_value() && place->link.has_value();
  }));
}

std::optional<AuditTable::Place> AuditTable::PlaceOf(const std::string& cell) {
  for (const NamedAuditColumn& known : kAuditColumns) {
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

absl::StatusOr<AuditTable::Places> AuditTable::PlacesOf(const CsvReader& reader, const std::string& name) {
  Places places;
  for (size_t i = 0; i < reader.header().size(); ++i) {
    const std::string& cell = reader.header()[i];
    if (reader.IsSkipped(i)) {
      places.emplace_back();
      continue;
    }
    const absl::StatusOr<std::string> full = FullName(cell, KnownNames(), absl::StrCat(name, " has the column"));
    if (!full.ok()) return full.status();
    const std::optional<Place> place = PlaceOf(*full);
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

absl::StatusOr<AuditTable> AuditTable::Open(std::istream& stream, const std::string& name,
                                            const std::vector<std::string>& skipped) {
  absl::StatusOr<CsvReader> reader = CsvReader::Open(stream, name);
  if (!reader.ok()) return reader.status();
  if (absl::Status status = reader->Skip(skipped); !status.ok()) return status;
  absl::StatusOr<Places> places = PlacesOf(*reader, name);
  if (!places.ok()) return places.status();
  return AuditTable(*std::move(reader), *std::move(places));
}

bool AuditTable::has_uncertainty() const {
  return std::any_of(places_.begin(), places_.end(), [](const std::optional<Place>& place) {
    return place.has_value() && place->values == &AuditColumns::velocity_uncertainty_m_s;
  });
}

absl::StatusOr<AuditRows> AuditTable::Next(size_t most) {
  absl::StatusOr<CsvTable> read = reader_.Next(most);
  if (!read.ok()) return read.status();
  CsvTable& table = *read;
  AuditRows rows{.columns = {}, .lines = std::move(table.lines), .bad_cells = {}};
  rows.columns.rates_after_rad_s.resize(LinkCount(places_));
  for (size_t i = 0; i < places_.size(); ++i) {
    const std::optional<Place>& place = places_[i];
    if (!place.has_value()) continue;
    (place->link.has_value() ? rows.columns.rates_after_rad_s[*place->link] : rows.columns.*place->values) =
        std::move(table.columns[i]);
  }
  rows.bad_cells.resize(rows.lines.size());
  for (const BadCells& bad : table.bad) rows.bad_cells[bad.row] = bad.Reason();
  return rows;
}

std::string WhyInvalid(const AuditRows& rows, size_t row) {
  const AuditColumns& columns = rows.columns;
  if (!rows.bad_cells[row].empty()) return rows.bad_cells[row];
  for (const NamedAuditColumn& known : kAuditColumns) {
    const bool is_signed =
        known.values != &AuditColumns::friction && known.values != &AuditColumns::velocity_uncertainty_m_s;
    const double least = is_signed ? std::numeric_limits<double>::lowest() : 0.0;
    std::string reason = WhyWrong(known.name, columns.*known.values, row, least);
    if (!reason.empty()) return reason;
  }
  for (size_t i = 0; i < columns.rates_after_rad_s.size(); ++i) {
    std::string reason = WhyWrong(absl::StrCat(kRates, "[", i, "]"), columns.rates_after_rad_s[i], row,
                                  std::numeric_limits<double>::lowest());
    if (!reason.empty()) return reason;
  }
  return "the contact cannot have this velocity before the impact, or a number exceeds the largest double";
}

}  // namespace ricochet::cli
