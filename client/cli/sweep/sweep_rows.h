// SweepRows: makes a SweepTable of the rows of a file, by the names of their cells.

#ifndef RICOCHET_CLIENT_CLI_SWEEP_SWEEP_ROWS_H_
#define RICOCHET_CLIENT_CLI_SWEEP_SWEEP_ROWS_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/cli/sweep/sweep_table.h"

namespace ricochet::cli {

class SweepRows {
 public:
  enum class Kind { kSkipped, kNumber, kRegime, kStatus };

  // `names` are those of the cells of each row: the index, the axes, the columns, and what else a sweep writes.
  // `wanted` are the columns to read, empty: all. Errors: INVALID_ARGUMENT if the names are not those of a sweep, or a
  // wanted one is not among them.
  static absl::StatusOr<SweepRows> Create(const std::vector<std::string>& names,
                                          const std::vector<std::string>& wanted);

  // Returns how a cell is read.
  Kind KindOf(size_t cell) const { return kinds_[cell]; }
  // Call one of these for each cell that is not skipped, row by row.
  void AddNumber(size_t cell, double value);
  // Adds a regime or a status, by its name or by its number. The reason behind the name of a status is not kept.
  // Errors: INVALID_ARGUMENT if there is none of that name or number.
  absl::Status AddName(size_t cell, const std::string& name);
  absl::Status AddCode(size_t cell, int64_t number);

  SweepTable& table() { return table_; }

 private:
  std::vector<Kind> kinds_;
  std::vector<size_t> places_;  // The place of a number is its axis, or the number of axes plus its column.
  SweepTable table_;
};

// Returns the error for a file of more than SweepTable::kMostPoints points.
absl::Status TooManyPoints();

// Chooses `wanted` among the columns of a file; all, if none is named.
// Errors: INVALID_ARGUMENT for a name that is not there or is there twice.
absl::StatusOr<std::vector<std::string>> ChooseColumns(const std::vector<std::string>& columns,
                                                       const std::vector<std::string>& wanted);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_SWEEP_SWEEP_ROWS_H_
