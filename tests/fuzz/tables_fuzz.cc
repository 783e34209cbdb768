// Fuzzes the reading of tables of data: bytes are CSV text, after one byte that says whether they are any table or one
// of observed impacts, and how many rows are read at a time.
//
// It checks that a table is read or refused with a reason; that its columns are equally long and its lines in order;
// that each bad row has a reason, and each row that is not bad has as many numbers as it has columns; that it is the
// same read in parts and as a whole; and that a table of its names and numbers is read as the same numbers.
//
// tests/fuzz/run.sh lists the code that it covers.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "client/cli/input/audit_data.h"
#include "client/cli/io/csv_row.h"
#include "client/cli/io/csv_table.h"
#include "core/base/decimal.h"
#include "ricochet/scene.h"
#include "tests/fuzz/fail.h"

namespace ricochet::cli {
namespace {

constexpr size_t kAll = std::numeric_limits<size_t>::max();

void CheckStatus(const absl::Status& status) {
  if (status.ok()) return;
  if (status.code() != absl::StatusCode::kInvalidArgument || status.message().empty()) Fail(status.ToString());
}

bool Same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

bool Same(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return false;
  for (size_t i = 0; i < a.size(); ++i) {
    if (!Same(a[i], b[i])) return false;
  }
  return true;
}

absl::StatusOr<CsvTable> ReadWhole(const std::string& text) {
  std::istringstream stream(text);
  absl::StatusOr<CsvReader> reader = CsvReader::Open(stream, "the table");
  if (!reader.ok()) return reader.status();
  return reader->Next(kAll);
}

// `lines` are those of a table that was read from its beginning, or from after `before` on.
void CheckLines(const std::vector<int64_t>& lines, int64_t before) {
  for (const int64_t line : lines) {
    if (line <= before) Fail("lines run back");
    before = line;
  }
}

void CheckShape(const CsvTable& table) {
  if (table.columns.size() != table.header.size()) Fail("another number of columns than of names");
  for (const std::vector<double>& column : table.columns) {
    if (column.size() != table.lines.size()) Fail("a column of another length");
  }
  size_t next = 0;
  for (const BadCells& bad : table.bad) {
    if (bad.row < next || bad.row >= table.lines.size()) Fail("bad rows are out of order");
    if (bad.description.empty()) Fail("a bad row has no reason");
    next = bad.row + 1;
  }
}

void Append(const CsvTable& part, CsvTable& whole) {
  for (BadCells bad : part.bad) {
    bad.row += whole.lines.size();
    whole.bad.push_back(std::move(bad));
  }
  whole.lines.insert(whole.lines.end(), part.lines.begin(), part.lines.end());
  for (size_t i = 0; i < part.columns.size(); ++i) {
    whole.columns[i].insert(whole.columns[i].end(), part.columns[i].begin(), part.columns[i].end());
  }
}

void CheckSame(const CsvTable& one, const CsvTable& other, const char* what) {
  const auto same_bad = [](const BadCells& a, const BadCells& b) { return a.row == b.row && a.Reason() == b.Reason(); };
  const bool same = one.lines == other.lines &&
                    std::equal(one.bad.begin(), one.bad.end(), other.bad.begin(), other.bad.end(), same_bad);
  if (!same) Fail(absl::StrCat(what, " has other rows"));
  for (size_t i = 0; i < one.columns.size(); ++i) {
    if (!Same(one.columns[i], other.columns[i])) Fail(absl::StrCat(what, " has other numbers"));
  }
}

void CheckParts(const std::string& text, const CsvTable& whole, size_t most) {
  std::istringstream stream(text);
  absl::StatusOr<CsvReader> reader = CsvReader::Open(stream, "the table");
  if (!reader.ok()) Fail("a table is refused the second time");
  CsvTable joined = {.header = whole.header, .columns = {}, .lines = {}, .bad = {}};
  joined.columns.resize(whole.columns.size());
  while (true) {
    const absl::StatusOr<CsvTable> part = reader->Next(most);
    if (!part.ok()) Fail("a part of a table is refused");
    if (part->lines.empty()) break;
    if (part->lines.size() > most) Fail("a part has more rows than were asked for");
    Append(*part, joined);
  }
  CheckSame(joined, whole, "a table in parts");
}

// A row that is bad has NaN in place of a number, and keeps it.
void CheckWrittenAgain(const CsvTable& table) {
  std::string text;
  for (const std::string& name : table.header) absl::StrAppend(&text, text.empty() ? "" : ",", CsvQuoted(name));
  for (size_t row = 0; row < table.lines.size(); ++row) {
    for (size_t i = 0; i < table.columns.size(); ++i) {
      const double number = table.columns[i][row];
      absl::StrAppend(&text, i == 0 ? "\n" : ",", std::isnan(number) ? "\"none\"" : ShortestDecimal(number));
    }
  }
  const absl::StatusOr<CsvTable> again = ReadWhole(text);
  if (!again.ok()) Fail(absl::StrCat("a table that was written is refused: ", again.status().ToString()));
  if (again->header != table.header) Fail("a table that was written has other names");
  for (size_t i = 0; i < table.columns.size(); ++i) {
    if (!Same(table.columns[i], again->columns[i])) Fail("a table that was written has other numbers");
  }
}

void CheckAnyTable(const std::string& text, size_t most) {
  const absl::StatusOr<CsvTable> table = ReadWhole(text);
  CheckStatus(table.status());
  if (!table.ok()) return;
  CheckShape(*table);
  CheckLines(table->lines, 0);
  CheckParts(text, *table, most);
  CheckWrittenAgain(*table);
}

void CheckAuditTable(const std::string& text, size_t most, bool skips) {
  std::istringstream stream(text);
  std::vector<std::string> skipped;
  if (skips) skipped = {"comment"};
  const Scene scene = {.system = Linkage{.links = {Link(), Link()}}};
  absl::StatusOr<AuditTable> table = AuditTable::Open(stream, "the table", scene, skipped);
  CheckStatus(table.status());
  if (!table.ok()) return;
  int64_t before = 0;
  while (true) {
    const absl::StatusOr<AuditRows> part = table->Next(most);
    CheckStatus(part.status());
    if (!part.ok() || part->lines.empty()) break;
    const AuditRows& rows = *part;
    if (rows.lines.size() > most || rows.bad_cells.size() != rows.lines.size()) Fail("another number of rows");
    CheckLines(rows.lines, before);
    before = rows.lines.back();
    const AuditColumns& columns = rows.columns;
    for (const std::vector<double>& rates : columns.rates_after) {
      if (rates.size() != rows.lines.size()) Fail("rates of another length");
    }
    for (const auto* column : {&columns.tangential_m_s, &columns.normal_m_s, &columns.tangential_after_m_s,
                               &columns.normal_after_m_s, &columns.friction, &columns.velocity_uncertainty_m_s}) {
      if (!column->empty() && column->size() != rows.lines.size()) Fail("a column of another length");
    }
    for (size_t row = 0; row < rows.lines.size(); ++row) {
      if (!rows.bad_cells[row].empty() && WhyInvalid(rows, row).empty()) Fail("a bad cell has no reason");
    }
  }
  if (table->bytes() < before) Fail("fewer bytes are read than lines");
}

}  // namespace
}  // namespace ricochet::cli

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  const size_t most = data[0] % 8 == 0 ? ricochet::cli::kAll : data[0] % 8;
  if ((data[0] & 8U) == 0) {
    ricochet::cli::CheckAnyTable(text, most);
  } else {
    ricochet::cli::CheckAuditTable(text, most, (data[0] & 16U) != 0);
  }
  return 0;
}
