#include "client/cli/solve_data.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iostream>
#include <limits>
#include <sstream>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/cli/csv_table.h"
#include "client/cli/json/json_text.h"
#include "client/cli/number_input.h"
#include "client/cli/output.h"
#include "client/cli/scene_input.h"
#include "client/cli/short_name.h"
#include "client/cli/sweep_head.h"
#include "client/cli/table.h"
#include "core/numerics/decimal.h"
#include "core/sweep/column.h"
#include "proto/wire/batch.h"
#include "proto/wire/engine.h"

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

// Opens the table, whose header then has the full paths of the fields of the scene that it means.
absl::StatusOr<CsvReader> OpenTable(std::istream& stream, const DataOptions& data, const Scene& scene) {
  absl::StatusOr<CsvReader> reader = CsvReader::Open(stream, data.file == "-" ? "standard input" : data.file);
  if (!reader.ok()) return reader.status();
  if (absl::Status status = reader->Skip(data.skipped_columns); !status.ok()) return status;
  for (size_t i = 0; i < reader->header().size(); ++i) {
    if (reader->IsSkipped(i)) continue;
    const absl::StatusOr<std::string> field = FullField(scene, reader->header()[i], "--data, column");
    if (!field.ok()) return field.status();
    reader->Define(i, *field, SpellingOf(*field) == Spelling::kAngle ? CellKind::kAngle : CellKind::kNumber);
  }
  return reader;
}

// A cell that is no number says more than the NaN that the solver was given in its place.
void NameBadCells(const std::vector<BadCells>& cells, BatchSummary& summary) {
  for (BadRow& row : summary.bad_rows) {
    for (const BadCells& bad : cells) {
      if (static_cast<int64_t>(bad.row) != row.row) continue;
      row.field = bad.column;
      row.description = bad.description;
    }
  }
}

absl::Status Solve(CsvReader& reader, const Solver& solver, Solved& solved) {
  const CsvTable table = reader.Next(std::numeric_limits<size_t>::max());
  const size_t count = table.lines.size();
  solved.outputs.assign(solved.setup.columns.size(), std::vector<double>(count));
  solved.lines = table.lines;
  solved.regimes.resize(count);
  solved.statuses.resize(count);
  BatchRows rows = {.regimes = absl::MakeSpan(solved.regimes), .statuses = absl::MakeSpan(solved.statuses)};
  for (size_t i = 0; i < table.columns.size(); ++i) {
    if (reader.IsSkipped(i)) continue;
    solved.setup.fields.push_back(table.header[i]);
    rows.inputs.emplace_back(table.columns[i]);
  }
  for (std::vector<double>& column : solved.outputs) rows.outputs.push_back(absl::MakeSpan(column));
  absl::StatusOr<BatchResponse> response = solver.SolveBatch(solved.setup, rows);
  if (!response.ok()) return response.status();
  solved.response = *std::move(response);
  NameBadCells(table.bad, solved.response.summary);
  return absl::OkStatus();
}

int64_t InvalidRows(const BatchSummary& summary) {
  return summary.counts.by_regime[static_cast<size_t>(Regime::kInvalid)].count;
}

std::string SummaryText(const Solved& solved) {
  const BatchSummary& summary = solved.response.summary;
  const int64_t invalid = InvalidRows(summary);
  std::string text = absl::StrCat(summary.counts.points, summary.counts.points == 1 ? " row, " : " rows, ", invalid,
                                  " without numbers, ", summary.counts.inadmissible.count, " inadmissible\n");
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

std::string Text(const Solved& solved, size_t rows) {
  Table table;
  table.Add(Names(solved));
  for (size_t i = 0; i < rows; ++i) {
    std::vector<std::string> cells = {absl::StrCat(i)};
    for (const std::vector<double>& column : solved.outputs) cells.push_back(Rounded(column[i]));
    cells.push_back(RegimeText(solved.regimes[i]));
    cells.push_back(StatusName(solved.statuses[i]));
    table.Add(cells);
  }
  std::string text = table.Render(0);
  if (solved.regimes.size() > rows) {
    absl::StrAppend(&text, "... and ", solved.regimes.size() - rows, " more rows; --format csv has them all\n");
  }
  return absl::StrCat(text, "\n", SummaryText(solved));
}

std::string Csv(const Solved& solved) {
  std::string text = absl::StrJoin(Names(solved), ",") + "\n";
  for (size_t i = 0; i < solved.regimes.size(); ++i) {
    absl::StrAppend(&text, i);
    for (const std::vector<double>& column : solved.outputs) absl::StrAppend(&text, ",", ShortestDecimal(column[i]));
    absl::StrAppend(&text, ",", RegimeName(solved.regimes[i]), ",", StatusName(solved.statuses[i]), "\n");
  }
  return text;
}

// Returns the cells of a row as JSON, in the order of Names().
std::vector<std::string> JsonCells(const Solved& solved, size_t row) {
  std::vector<std::string> cells(1);
  AppendJson(static_cast<int64_t>(row), cells.back());
  for (const std::vector<double>& column : solved.outputs) AppendJson(column[row], cells.emplace_back());
  AppendJson(RegimeName(solved.regimes[row]), cells.emplace_back());
  AppendJson(StatusName(solved.statuses[row]), cells.emplace_back());
  return cells;
}

// Returns one document: the columns with their units, a list for each row, and the summary.
std::string JsonDocument(const Solved& solved) {
  std::string text = absl::StrCat("{\"engine\":", JsonOf(ToProto(solved.response.engine)),
                                  ",\"columns\":", ColumnsJson(Names(solved)), ",\"values\":[");
  for (size_t i = 0; i < solved.regimes.size(); ++i) {
    absl::StrAppend(&text, i == 0 ? "\n[" : ",\n[", absl::StrJoin(JsonCells(solved, i), ","), "]");
  }
  return absl::StrCat(text, "\n],\"summary\":", JsonOf(ToProto(solved.response.summary)), "}\n");
}

// Returns an object on a line for each row.
std::string JsonLines(const Solved& solved) {
  std::vector<std::string> keys;
  for (const std::string& name : Names(solved)) AppendJson(name, keys.emplace_back());
  std::string text;
  for (size_t i = 0; i < solved.regimes.size(); ++i) {
    const std::vector<std::string> cells = JsonCells(solved, i);
    for (size_t c = 0; c < cells.size(); ++c) absl::StrAppend(&text, c == 0 ? "{" : ",", keys[c], ":", cells[c]);
    text += "}\n";
  }
  return text;
}

absl::Status Write(const Solved& solved, const CommonOptions& options, size_t rows) {
  if (options.format == Format::kText) return WriteOutput(options, Text(solved, rows));
  if (options.format == Format::kJson) return WriteOutput(options, JsonDocument(solved));
  absl::Status written = WriteOutput(options, options.format == Format::kCsv ? Csv(solved) : JsonLines(solved));
  if (written.ok()) std::cerr << SummaryText(solved);
  return written;
}

}  // namespace

absl::Status SolveData(const DataOptions& data, const CommonOptions& options, const Solver& solver, const Scene& scene,
                       const DemandFields& demand) {
  const absl::StatusOr<std::string> text = ReadText(data.file);
  if (!text.ok()) return text.status();
  std::istringstream stream(*text);
  absl::StatusOr<CsvReader> reader = OpenTable(stream, data, scene);
  if (!reader.ok()) return reader.status();
  const absl::StatusOr<std::vector<std::string>> columns = FullColumns(scene, data.columns);
  if (!columns.ok()) return columns.status();
  Solved solved = {.setup = {.scene = scene,
                             .fields = {},
                             .columns = columns->empty() ? DefaultColumns(scene) : *columns,
                             .demand = demand}};
  if (absl::Status status = Solve(*reader, solver, solved); !status.ok()) return status;
  absl::StatusOr<int64_t> rows = static_cast<int64_t>(solved.lines.size());
  if (options.format == Format::kText) rows = RowsOfTable(options, *rows);
  if (!rows.ok()) return rows.status();
  if (absl::Status status = Write(solved, options, static_cast<size_t>(*rows)); !status.ok()) return status;
  const BatchSummary& summary = solved.response.summary;
  const int64_t bad = InvalidRows(summary) + summary.counts.inadmissible.count;
  if (!data.strict || bad == 0) return absl::OkStatus();
  return absl::FailedPreconditionError(absl::StrCat(bad, " of ", summary.counts.points, " rows are not admissible"));
}

}  // namespace ricochet::cli
