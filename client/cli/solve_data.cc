#include "client/cli/solve_data.h"

#include <cstddef>
#include <iostream>
#include <limits>
#include <sstream>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"
#include "client/cli/input/scene_input.h"
#include "client/cli/input/short_name.h"
#include "client/cli/io/csv_table.h"
#include "client/cli/io/row_writer.h"
#include "client/cli/sweep/sweep_head.h"
#include "client/cli/text/enum_names.h"
#include "client/cli/text/json_text.h"
#include "client/cli/text/number_input.h"
#include "core/base/counted.h"
#include "core/base/try.h"
#include "core/rows/column.h"
#include "proto/wire/batch.h"
#include "proto/wire/engine.h"
#include "ricochet/error.h"

namespace ricochet::cli {
namespace {

// A batch and its answer.
struct Solved {
  BatchSetup setup;
  std::vector<int64_t> lines;  // The line of each row in the table.
  std::vector<std::vector<double>> outputs;
  std::vector<Regime> regimes;
  std::vector<RowStatus> statuses;
  BatchResponse response;
};

std::vector<std::string> DefaultColumns(const Scene& scene) {
  std::vector<std::string> columns;
  for (std::string& column : Columns(scene)) {
    if (absl::StartsWith(column, "contact_velocity_after.") || absl::StartsWith(column, "impulse.")) {
      columns.push_back(std::move(column));
    }
  }
  return columns;
}

// Opens the table and gives its header the full paths of the scene's fields.
absl::StatusOr<CsvReader> OpenTable(std::istream& stream, const DataOptions& data, const Scene& scene) {
  absl::StatusOr<CsvReader> reader = CsvReader::Open(stream, data.file == "-" ? "standard input" : data.file);
  if (!reader.ok()) return reader.status();
  if (absl::Status status = reader->Skip(data.skipped_columns); !status.ok()) return status;
  for (size_t i = 0; i < reader->header().size(); ++i) {
    if (reader->IsSkipped(i)) continue;
    RICOCHET_TRY(const std::string field, FullField(scene, reader->header()[i], "--data, column"));
    reader->Define(i, field, CellKindOf(field));
  }
  return reader;
}

// Names the cell that is no number as the reason of a bad row: the solver saw only a NaN in its place.
void NameBadCells(const std::vector<BadCells>& cells, BatchSummary& summary) {
  for (BadRow& row : summary.bad_rows) {
    for (const BadCells& bad : cells) {
      if (static_cast<int64_t>(bad.row) != row.row) continue;
      row.field = bad.column;
      row.description = bad.description;
    }
  }
}

// Names the columns of the file in place of the fields of the request. `columns` are their places in the file.
absl::Status NameColumns(const absl::Status& error, const std::vector<size_t>& columns) {
  std::vector<Violation> violations = ViolationsOf(error);
  for (Violation& violation : violations) {
    absl::string_view place = violation.field;
    size_t field = 0;
    if (!absl::ConsumePrefix(&place, "fields[") || !absl::ConsumeSuffix(&place, "]")) continue;
    if (!absl::SimpleAtoi(place, &field) || field >= columns.size()) continue;
    violation.field = absl::StrCat("--data, column ", columns[field] + 1);
    for (size_t i = 0; i < columns.size(); ++i) {
      const std::string other = absl::StrCat("fields[", i, "]");
      violation.description =
          absl::StrReplaceAll(violation.description, {{other, absl::StrCat("column ", columns[i] + 1)}});
    }
    absl::StrAppend(&violation.description, "; --skip-column leaves a column out");
  }
  return violations.empty() ? error : WithViolations(error, violations);
}

absl::Status Solve(CsvReader& reader, const Solver& solver, Solved& solved) {
  RICOCHET_TRY(const CsvTable table, reader.Next(std::numeric_limits<size_t>::max()));
  const size_t count = table.lines.size();
  solved.outputs.assign(solved.setup.columns.size(), std::vector<double>(count));
  solved.lines = table.lines;
  solved.regimes.resize(count);
  solved.statuses.resize(count);
  BatchRows rows = {.regimes = absl::MakeSpan(solved.regimes), .statuses = absl::MakeSpan(solved.statuses)};
  std::vector<size_t> columns;
  for (size_t i = 0; i < table.columns.size(); ++i) {
    if (reader.IsSkipped(i)) continue;
    columns.push_back(i);
    solved.setup.fields.push_back(table.header[i]);
    rows.inputs.emplace_back(table.columns[i]);
  }
  for (std::vector<double>& column : solved.outputs) rows.outputs.push_back(absl::MakeSpan(column));
  absl::StatusOr<BatchResponse> response = solver.SolveBatch(solved.setup, rows);
  if (!response.ok()) return NameColumns(response.status(), columns);
  solved.response = *std::move(response);
  NameBadCells(table.bad, solved.response.summary);
  return absl::OkStatus();
}

// Counts the rows that --strict makes an error.
int64_t BadRows(const Solved& solved) {
  int64_t count = 0;
  for (size_t row = 0; row < solved.regimes.size(); ++row) {
    count += HasEnd(solved.regimes[row]) && solved.statuses[row] != RowStatus::kInadmissible ? 0 : 1;
  }
  return count;
}

std::string SummaryText(const Solved& solved) {
  const BatchSummary& summary = solved.response.summary;
  const int64_t invalid = summary.counts.by_regime[static_cast<size_t>(Regime::kInvalid)].count;
  int64_t endless = 0, inexact = 0;
  for (size_t row = 0; row < solved.regimes.size(); ++row) {
    if (solved.regimes[row] == Regime::kInvalid) continue;
    const bool has_end = HasEnd(solved.regimes[row]);
    endless += has_end ? 0 : 1;
    inexact += has_end && solved.statuses[row] == RowStatus::kNotConverged ? 1 : 0;
  }
  std::string text = absl::StrCat(Counted(summary.counts.points, "row"), ", ", invalid, " without numbers, ",
                                  summary.counts.inadmissible.count, " inadmissible, ", endless,
                                  " without an end or a solution, ", inexact, " less accurate than asked\n");
  const int64_t separating = summary.counts.by_regime[static_cast<size_t>(Regime::kSeparating)].count;
  if (separating > 0) {
    absl::StrAppend(&text, "  nothing strikes in ", Counted(separating, "row"),
                    ": the normal velocity before is not negative there\n");
  }
  for (const BadRow& bad : summary.bad_rows) {
    absl::StrAppend(&text, "  row ", bad.row, " (line ", solved.lines[static_cast<size_t>(bad.row)], "): ", bad.field,
                    bad.field.empty() ? "" : " ", bad.description, "\n");
  }
  if (invalid > static_cast<int64_t>(summary.bad_rows.size())) {
    absl::StrAppend(&text, "  and ", invalid - static_cast<int64_t>(summary.bad_rows.size()), " more\n");
  }
  return text;
}

std::vector<std::string> Names(const Solved& solved) {
  std::vector<std::string> names = {"row"};
  names.insert(names.end(), solved.setup.columns.begin(), solved.setup.columns.end());
  names.insert(names.end(), {"regime", "status"});
  return names;
}

void Visit(const Solved& solved, size_t place, RowWriter& row) {
  row.Integer(static_cast<int64_t>(place));
  for (const std::vector<double>& column : solved.outputs) row.Number(column[place]);
  row.Kind(solved.regimes[place]);
  row.Words(StatusName(solved.statuses[place]));
}

// Returns the first `count` rows. A table and a document, which has the columns with their units, end with the summary.
std::string Text(const Solved& solved, Format format, size_t count) {
  std::string text;
  if (format == Format::kJson) {
    text = absl::StrCat("{\"engine\":", JsonOf(ToProto(solved.response.engine)),
                        ",\"columns\":", ColumnsJson(Names(solved)), ",\"values\":");
  }
  RowWriter rows(format, Names(solved));
  rows.Begin(text);
  for (size_t i = 0; i < count; ++i) {
    rows.Add(text, [&](RowWriter& row) { Visit(solved, i, row); });
  }
  rows.End(text);
  if (format == Format::kJson) {
    absl::StrAppend(&text, ",\"summary\":", JsonOf(ToProto(solved.response.summary)), "}\n");
  } else if (format == Format::kText) {
    const size_t left_out = solved.regimes.size() - count;
    if (left_out > 0) {
      absl::StrAppend(&text, "... and ", Counted(left_out, "more row"), "; --format csv has them all\n");
    }
    absl::StrAppend(&text, "\n", SummaryText(solved));
  }
  return text;
}

absl::Status Write(const Solved& solved, const CommonOptions& options, size_t rows) {
  absl::Status written = WriteOutput(options, Text(solved, options.format, rows));
  const bool has_summary = options.format == Format::kText || options.format == Format::kJson;
  if (written.ok() && !has_summary) std::cerr << SummaryText(solved);
  return written;
}

}  // namespace

absl::Status SolveData(const DataOptions& data, const CommonOptions& options, const Solver& solver, const Scene& scene,
                       const DemandFields& demand) {
  RICOCHET_TRY(const std::string text, ReadText(data.file));
  std::istringstream stream(text);
  RICOCHET_TRY(CsvReader reader, OpenTable(stream, data, scene));
  RICOCHET_TRY(const std::vector<std::string> columns, FullColumns(scene, data.columns));
  Solved solved = {.setup = {.scene = scene,
                             .fields = {},
                             .columns = columns.empty() ? DefaultColumns(scene) : columns,
                             .demand = demand}};
  if (absl::Status status = Solve(reader, solver, solved); !status.ok()) return status;
  absl::StatusOr<int64_t> rows = static_cast<int64_t>(solved.lines.size());
  if (options.format == Format::kText) rows = RowsOfTable(options, *rows);
  if (!rows.ok()) return rows.status();
  if (absl::Status status = Write(solved, options, static_cast<size_t>(*rows)); !status.ok()) return status;
  const int64_t bad = BadRows(solved);
  if (!data.strict || bad == 0) return absl::OkStatus();
  return absl::FailedPreconditionError(
      absl::StrCat(bad, " of ", solved.regimes.size(), " rows are invalid, inadmissible or have no end"));
}

}  // namespace ricochet::cli
