// Tables of observed impacts: CSV text with a header.

#ifndef RICOCHET_CLIENT_CLI_INPUT_AUDIT_DATA_H_
#define RICOCHET_CLIENT_CLI_INPUT_AUDIT_DATA_H_

#include <cstddef>
#include <cstdint>
#include <istream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/io/csv_table.h"
#include "ricochet/audit.h"
#include "ricochet/scene.h"

namespace ricochet::cli {

// Some rows of a table.
struct AuditRows {
  AuditColumns columns;
  std::vector<InputColumn> inputs;
  std::vector<int64_t> lines;           // The line of each row in the text, from 1.
  std::vector<std::string> bad_cells;   // For each row, why it has a NaN; empty if it has none.
  std::vector<std::string> velocities;  // The paths of columns.rates_after.
};

// Reads a table of observed impacts part by part. Columns are named as the fields of AuditColumns, those of rates_after
// as the velocities of the system in an outcome, such as rates_after_rad_s[0], and inputs as fields of the scene. They
// may come in any order. CsvReader says how cells are read; a bad cell makes its row invalid but no other.
class AuditTable {
 public:
  // `name` names the table in errors. Columns named in `skipped` are left out. The stream must outlive the table.
  // Errors: INVALID_ARGUMENT for a header that names an unknown column or one twice, has some velocities of the system
  // but not all, has semicolons or lacks a column of `skipped`.
  static absl::StatusOr<AuditTable> Open(std::istream& stream, const std::string& name, const Scene& scene,
                                         const std::vector<std::string>& skipped);

  // True if the table states the uncertainty of each row.
  bool has_uncertainty() const;
  // Returns the next rows, at most `most`; none at the end. Errors: those of CsvReader::Next.
  absl::StatusOr<AuditRows> Next(size_t most);
  size_t columns() const { return places_.size(); }
  // The bytes read so far.
  int64_t bytes() const { return reader_.bytes(); }

 private:
  // The destination of a column of the file: a named column, a velocity of the system or a field of the scene.
  struct Place {
    std::vector<double> AuditColumns::*values = nullptr;
    std::optional<size_t> velocity;
    std::string field;
    friend bool operator==(const Place&, const Place&) = default;
  };
  using Places = std::vector<std::optional<Place>>;  // Absent for a column that is left out.

  AuditTable(CsvReader reader, const Scene& scene);
  std::vector<std::string> KnownNames() const;
  std::optional<Place> PlaceOf(const std::string& cell) const;
  absl::StatusOr<std::string> FullColumn(const std::string& cell, const std::string& name) const;
  absl::Status SetPlaces(const std::string& name);

  CsvReader reader_;
  std::vector<std::string> velocities_;
  std::vector<std::string> fields_;
  Places places_;
};

// Returns which cell makes a row of `rows` invalid, and why; empty if none does by itself.
std::string WhyInvalid(const AuditRows& rows, size_t row);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_INPUT_AUDIT_DATA_H_
