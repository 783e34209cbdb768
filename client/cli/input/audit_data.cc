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
#include "core/base/try.h"
#include "core/scene/field.h"
#include "core/scene/system_velocities.h"
#include "ricochet/audit_columns.h"

namespace ricochet::cli {
namespace {

absl::Status UnknownColumn(const std::string& cell, const std::string& name, const std::vector<std::string>& known,
                           const std::vector<std::string>& fields) {
  const std::string near = DidYouMean(cell, known);
  return absl::InvalidArgumentError(absl::StrCat(name, " has the column \"", absl::CEscape(cell), "\": must be one of ",
                                                 absl::StrJoin(known, ", "), ", or a field of the scene",
                                                 near.empty() ? DidYouMean(cell, fields) : near,
                                                 "; --skip-column leaves a column out"));
}

// Returns why a value is not finite or below `least`; empty if neither is so.
std::string WhyWrong(absl::string_view name, const std::vector<double>& column, size_t row, double least) {
  if (column.empty() || (std::isfinite(column[row]) && column[row] >= least)) return "";
  return absl::StrCat(name, " = ", ShortestDecimal(column[row]), ": must be ",
                      std::isfinite(column[row]) ? absl::StrCat(">= ", least) : "finite");
}

}  // namespace

AuditTable::AuditTable(CsvReader reader, const Scene& scene)
    : reader_(std::move(reader)), velocities_(SystemVelocityPaths(scene.system)), fields_(AllFieldPaths(scene)) {}

std::vector<std::string> AuditTable::KnownNames() const {
  std::vector<std::string> known;
  for (const NamedAuditColumn& column : kAuditColumns) known.emplace_back(column.name);
  known.insert(known.end(), velocities_.begin(), velocities_.end());
  return known;
}

std::optional<AuditTable::Place> AuditTable::PlaceOf(const std::string& cell) const {
  for (const NamedAuditColumn& known : kAuditColumns) {
    if (cell == known.name) return Place{.values = known.values};
  }
  const auto found = std::find(velocities_.begin(), velocities_.end(), cell);
  if (found != velocities_.end()) {
    return Place{.velocity = static_cast<size_t>(found - velocities_.begin())};
  }
  if (std::count(fields_.begin(), fields_.end(), cell) == 0) return std::nullopt;
  return Place{.field = cell};
}

// A short name must not mean both an observed number and a field of the scene. If it means neither, it is returned.
absl::StatusOr<std::string> AuditTable::FullColumn(const std::string& cell, const std::string& name) const {
  if (PlaceOf(cell).has_value()) return cell;
  const std::string what = absl::StrCat(name, " has the column");
  const absl::StatusOr<std::string> observed = FullName(cell, KnownNames(), what);
  std::vector<std::string> fields;
  for (const std::string& field : fields_) {
    // The velocity of the surface must not be taken for the contact velocity that an audit compares.
    if (!PlaceOf(field.substr(field.rfind('.') + 1)).has_value()) fields.push_back(field);
  }
  absl::StatusOr<std::string> field = FullName(cell, fields, what);
  const bool is_observed = observed.ok() && PlaceOf(*observed).has_value();
  const bool is_field = field.ok() && PlaceOf(*field).has_value();
  if (is_observed && is_field) {
    return absl::InvalidArgumentError(
        absl::StrCat(what, " ", cell, ": must name one of\n  ", *observed, "\n  ", *field));
  }
  return is_field || (observed.ok() && !field.ok()) ? field : observed;
}

absl::Status AuditTable::SetPlaces(const std::string& name) {
  const std::vector<std::string> known = KnownNames();
  for (size_t i = 0; i < reader_.header().size(); ++i) {
    const std::string& cell = reader_.header()[i];
    if (reader_.IsSkipped(i)) {
      places_.emplace_back();
      continue;
    }
    RICOCHET_TRY(const std::string full, FullColumn(cell, name));
    const std::optional<Place> place = PlaceOf(full);
    if (!place.has_value()) return UnknownColumn(cell, name, known, fields_);
    if (std::count(places_.begin(), places_.end(), place) > 0) {
      return absl::InvalidArgumentError(absl::StrCat(name, " has the column ", cell, " twice"));
    }
    if (!place->field.empty()) reader_.Define(i, cell, CellKindOf(full));
    places_.push_back(place);
  }
  const auto has = [this](size_t velocity) {
    return std::count(places_.begin(), places_.end(), Place{.velocity = velocity}) > 0;
  };
  std::vector<std::string> missing;
  for (size_t k = 0; k < velocities_.size(); ++k) {
    if (!has(k)) missing.push_back(velocities_[k]);
  }
  if (missing.size() == velocities_.size()) {
    velocities_.clear();
  } else if (!missing.empty()) {
    return absl::InvalidArgumentError(absl::StrCat(name, " has some velocities of the system after the impact but not ",
                                                   absl::StrJoin(missing, ", "), ": must have all of them"));
  }
  return absl::OkStatus();
}

absl::StatusOr<AuditTable> AuditTable::Open(std::istream& stream, const std::string& name, const Scene& scene,
                                            const std::vector<std::string>& skipped) {
  RICOCHET_TRY(CsvReader reader, CsvReader::Open(stream, name));
  if (absl::Status status = reader.Skip(skipped); !status.ok()) return status;
  AuditTable table(std::move(reader), scene);
  if (absl::Status status = table.SetPlaces(name); !status.ok()) return status;
  return table;
}

bool AuditTable::has_uncertainty() const {
  return std::any_of(places_.begin(), places_.end(), [](const std::optional<Place>& place) {
    return place.has_value() && place->values == &AuditColumns::velocity_uncertainty_m_s;
  });
}

absl::StatusOr<AuditRows> AuditTable::Next(size_t most) {
  RICOCHET_TRY(CsvTable table, reader_.Next(most));
  AuditRows rows{
      .columns = {}, .inputs = {}, .lines = std::move(table.lines), .bad_cells = {}, .velocities = velocities_};
  rows.columns.rates_after.resize(velocities_.size());
  for (size_t i = 0; i < places_.size(); ++i) {
    const std::optional<Place>& place = places_[i];
    if (!place.has_value()) continue;
    if (!place->field.empty()) {
      rows.inputs.push_back({.path = place->field, .values = std::move(table.columns[i])});
      continue;
    }
    (place->velocity.has_value() ? rows.columns.rates_after[*place->velocity] : rows.columns.*place->values) =
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
  for (size_t i = 0; i < columns.rates_after.size(); ++i) {
    std::string reason =
        WhyWrong(rows.velocities[i], columns.rates_after[i], row, std::numeric_limits<double>::lowest());
    if (!reason.empty()) return reason;
  }
  return "";
}

}  // namespace ricochet::cli
