// Tables of numbers as CSV text with a header.

#ifndef RICOCHET_CLIENT_CLI_IO_CSV_TABLE_H_
#define RICOCHET_CLIENT_CLI_IO_CSV_TABLE_H_

#include <cstddef>
#include <cstdint>
#include <istream>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace ricochet::cli {

// Spreadsheets and some editors put this mark in front of a text in UTF-8.
inline constexpr char kByteOrderMark[] = "\xEF\xBB\xBF";

// Errors: INVALID_ARGUMENT for a text that begins with the byte order mark of UTF-16; `name` names it.
absl::Status RefuseUtf16(absl::string_view text, const std::string& name);

// A row that has a NaN in place of a number, and why.
struct BadCells {
  size_t row = 0;
  std::string column;       // The name of the first such column; empty if the row has too many cells.
  std::string description;  // It says what is wrong: `= "0,7": must be a number with a decimal point`.

  std::string Reason() const { return column.empty() ? description : column + " " + description; }
};

// Says how the cells of a column are read.
enum class CellKind { kNumber, kAngle, kSkipped };

struct CsvTable {
  std::vector<std::string> header;
  std::vector<std::vector<double>> columns;  // One for each name of the header, all equally long.
  std::vector<int64_t> lines;                // The line of each row in the text, from 1.
  std::vector<BadCells> bad;                 // In the order of their rows.
};

// Reads a table part by part, so that a long one takes little memory. Columns are separated by commas. A cell may stand
// in double quotes, and may then have commas and line ends. A cell that is missing or not a number becomes a NaN, and
// so do all cells of a row with more or fewer cells than the header. Empty lines, lines that start with # and a byte
// order mark are skipped.
class CsvReader {
 public:
  // Reads the header. `name` names the table in errors; the stream must live as long as the reader.
  // Errors: INVALID_ARGUMENT if there is no header, or if it has semicolons; those of Next.
  static absl::StatusOr<CsvReader> Open(std::istream& stream, const std::string& name);

  // The names of the columns, as the text or Define has them.
  const std::vector<std::string>& header() const { return header_; }
  // Leaves columns out: they have NaN in every row, and no reason for it.
  // Errors: INVALID_ARGUMENT for a name that the header lacks, or if no column is left.
  absl::Status Skip(const std::vector<std::string>& names);
  bool IsSkipped(size_t column) const { return kinds_[column] == CellKind::kSkipped; }
  // Sets the name by which a column is called from now on, and how its cells are read.
  void Define(size_t column, std::string name, CellKind kind);
  // Returns the next rows, at most `most`; none at the end. Errors: INVALID_ARGUMENT if the text ends within a cell in
  // quotes, because other rows are lost in it.
  absl::StatusOr<CsvTable> Next(size_t most);
  // Reads the cells of the next row as text. Returns false at the end. Errors: those of Next.
  absl::StatusOr<bool> NextRow(std::vector<std::string>& cells);
  // Returns why the last row, which has these cells, is none of the table; empty if it is one.
  std::string WhyNoRow(const std::vector<std::string>& cells) const;
  // The line of the text in which the last row begins, from 1.
  int64_t line() const { return number_; }
  // The bytes read so far.
  int64_t bytes() const { return bytes_; }

 private:
  CsvReader(std::istream& stream, std::string name) : stream_(&stream), name_(std::move(name)) {}
  // Reads up to the next line that is not skipped. Returns false at the end. Errors: those of Next.
  absl::StatusOr<bool> NextLine();
  bool ReadLine(std::string& line);
  // Appends a row to the table.
  void Append(const std::vector<std::string>& cells, CsvTable& table) const;

  std::istream* stream_;
  std::string name_;  // The table's name.
  std::vector<std::string> header_;
  std::vector<CellKind> kinds_;  // One for each name of the header.
  std::string line_;
  int64_t number_ = 0;  // The number of line_, or of its first part.
  int64_t lines_read_ = 0;
  int64_t bytes_ = 0;
};

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_IO_CSV_TABLE_H_
