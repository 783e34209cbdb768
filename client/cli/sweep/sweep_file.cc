#include "client/cli/sweep/sweep_file.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/cli/io/csv_table.h"
#include "client/cli/sweep/sweep_rows.h"
#include "core/base/counted.h"
#include "core/base/try.h"

namespace ricochet::cli {
namespace {

// Appends the number, the regime or the status of a cell. A sweep writes the shortest decimals, nan and inf.
absl::Status AddCell(const std::string& name, const std::string& text, size_t cell, SweepRows& rows) {
  if (rows.KindOf(cell) == SweepRows::Kind::kSkipped) return absl::OkStatus();
  if (rows.KindOf(cell) != SweepRows::Kind::kNumber) return rows.AddName(cell, text);
  double value = 0.0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value);
  if (error != std::errc() || end != last) {
    return absl::InvalidArgumentError(absl::StrCat(name, " = \"", absl::CEscape(text), "\": must be a number"));
  }
  rows.AddNumber(cell, value);
  return absl::OkStatus();
}

absl::Status AddRow(const std::vector<std::string>& names, const std::vector<std::string>& cells, SweepRows& rows) {
  if (cells.size() != names.size()) {
    return absl::InvalidArgumentError(
        absl::StrCat("has ", Counted(cells.size(), "cell"), ": must have ", names.size()));
  }
  for (size_t i = 0; i < names.size(); ++i) {
    if (absl::Status status = AddCell(names[i], cells[i], i, rows); !status.ok()) return status;
  }
  return absl::OkStatus();
}

absl::StatusOr<SweepTable> ReadCsv(std::istream& stream, const std::vector<std::string>& columns) {
  RICOCHET_TRY(CsvReader reader, CsvReader::Open(stream, "the table"));
  const std::vector<std::string>& names = reader.header();
  if (absl::StartsWith(names.front(), "index ")) {
    return absl::InvalidArgumentError("is a table for people, which is rounded: write it with --format csv");
  }
  if (names.front() == "kind") return absl::InvalidArgumentError("is a summary, which has no points");
  RICOCHET_TRY(SweepRows rows, SweepRows::Create(names, columns));
  std::vector<std::string> cells;
  for (int64_t points = 1;; ++points) {
    RICOCHET_TRY(const bool has_row, reader.NextRow(cells));
    if (!has_row) return std::move(rows.table());
    if (points > SweepTable::kMostPoints) return TooManyPoints();
    if (absl::Status status = AddRow(names, cells, rows); !status.ok()) {
      return absl::InvalidArgumentError(absl::StrCat("line ", reader.line(), ": ", status.message()));
    }
  }
}

absl::StatusOr<SweepTable> Read(std::ifstream& stream, const std::string& path,
                                const std::vector<std::string>& columns) {
  if (absl::StrContains(std::filesystem::path(path).filename().string(), ".shard-")) {
    return absl::InvalidArgumentError("is a shard of a sweep: ricochet merge makes one file of all shards");
  }
  std::string start(8, '\0');
  stream.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<size_t>(stream.gcount()));
  stream.clear();
  stream.seekg(0);
  if (start.empty()) return absl::InvalidArgumentError("is empty");
  if (absl::StartsWith(start, "\x93NUMPY")) return ReadSweepNpy(stream, columns);
  if (absl::StartsWith(start, "\x89HDF") || absl::StartsWith(start, "CDF")) return ReadSweepNetcdf(path, columns);
  if (std::any_of(start.begin(), start.end(),
                  [](unsigned char c) { return absl::ascii_iscntrl(c) && !absl::ascii_isspace(c); })) {
    return absl::InvalidArgumentError("is neither CSV nor JSON nor NPY nor NetCDF-4 of a sweep");
  }
  return start.front() == '{' ? ReadSweepJson(stream, columns) : ReadCsv(stream, columns);
}

}  // namespace

absl::StatusOr<SweepTable> ReadSweepFile(const std::string& path, const std::vector<std::string>& columns) {
  std::error_code unknown;  // A file that cannot be looked at cannot be opened either.
  if (std::filesystem::is_directory(path, unknown)) {
    return absl::InvalidArgumentError(absl::StrCat(path, ": is a directory: must be a file of a sweep"));
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return absl::InvalidArgumentError(absl::StrCat("cannot read ", path, ": ", std::strerror(errno)));
  absl::StatusOr<SweepTable> table = Read(stream, path, columns);
  if (stream.bad()) return absl::ErrnoToStatus(errno, path);
  if (!table.ok()) return absl::Status(table.status().code(), absl::StrCat(path, ": ", table.status().message()));
  if (table->points() == 0 && !table->axes.empty()) {
    return absl::InvalidArgumentError(absl::StrCat(path, ": has no points"));
  }
  return table;
}

}  // namespace ricochet::cli
