// Tables of numbers as CSV text with a header.

#ifndef RICOCHET_CLIENT_CLI_CSV_TABLE_H_
#define RICOCHET_CLIENT_CLI_CSV_TABLE_H_

#include <cstddef>
#include <cstdint>
#include <istream>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"

namespace ricochet::cli {

// A row that has a NaN in place of a number, and why.
struct BadCells {
  size_t row = 0;
  std::string reason;  // Of the first such cell: `normal_m_s = "0,7": must be a number with a decimal point`.
};

struct CsvTable {
  std::vector<std::string> header;
  std::vector<std::vector<double>> columns;  // One for each name of the header, all equally long.
  std::vector<int64_t> lines;                // The line of each row in the text, from 1.
  std::vector<BadCells> bad;                 // In the order of their rows.
};

// Reads a table part by part, so that a long one takes little memory. Columns are separated by commas. A cell may stand
// in double quotes, and may then have commas. A cell that is missing or not a number becomes a NaN, and so do all cells
// of a row with more cells than the header. Empty lines, lines that start with # and a byte order mark are skipped.
class CsvReader {
 public:
  // Reads the header. `name` names the table in errors; the stream must live as long as the reader.
  // Errors: INVALID_ARGUMENT if there is no header, or if it has semicolons.
  static absl::StatusOr<CsvReader> Open(std::istream& stream, const std::string& name);

  const std::vector<std::string>& header() const { return header_; }
  // Reads no numbers from the columns for which `skipped` is true: they have NaN in every row, and no reason for it.
  void Skip(std::vector<bool> skipped) { skipped_ = std::move(skipped); }
  // Returns the next rows, at most `most`; none at the end.
  CsvTable Next(size_t most);
  // Reads the cells of the next row as text. Returns false at the end.
  bool NextRow(std::vector<std::string>& cells);
  // The line of the last row in the text, from 1.
  int64_t line() const { return number_; }
  // The bytes read so far.
  int64_t bytes() const { return bytes_; }

 private:
  explicit CsvReader(std::istream& stream) : stream_(&stream) {}
  // Reads up to the next line that is not skipped. Returns false at the end.
  bool NextLine();
  // Appends a row to the table.
  void Append(const std::vector<std::string>& cells, CsvTable& table) const;

  std::istream* stream_;
  std::vector<std::string> header_;
  std::vector<bool> skipped_;  // Empty, or one for each name of the header.
  std::string line_;
  int64_t number_ = 0;  // That of line_.
  int64_t bytes_ = 0;
};

// Reads a whole table. Errors: those of CsvReader::Open.
absl::StatusOr<CsvTable> ParseCsvTable(const std::string& text, const std::string& name);

// Returns the text as a cell in double quotes, which may have commas and quotes.
std::string CsvQuoted(const std::string& text);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_CSV_TABLE_H_
