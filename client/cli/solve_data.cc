#include "client/cli/solve_data.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iostream>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/cli/csv_table.h"
#include "client/cli/json/json_text.h"
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

absl::Status Solve(const CsvTable& table, const Solver& solver, Solved& solved) {
  const size_t count = table.columns.front().size();
  solved.outputs.assign(solved.setup.columns.size(), std::vector<double>(count));
  solved.regimes.resize(count);
  solved.statuses.resize(count);
  BatchRows rows = {.regimes = absl::MakeSpan(solved.regimes), .statuses = absl::MakeSpan(solved.statuses)};
  for (const std::vector<double>& column : table.columns) rows.inputs.emplace_back(column);
  for (std::vector<double>& column : solved.outputs) rows.outputs.push_back(absl::MakeSpan(column));
  absl::StatusOr<BatchResponse> response = solver.SolveBatch(solved.setup, rows);
  if (response.ok()) solved.response = *std::move(response);
  return response.status();
}

std::string SummaryText(const BatchSummary& summary) {
  const auto invalid = summary.counts.by_regime[static_cast<size_t>(Regime::kInvalid)].count;
  std::string text = absl::StrCat(summary.counts.points, summary.counts.points == 1 ? " row, " : " rows, ", invalid,
                                  " without numbers, ", summary.counts.inadmissible.count, " inadmissible\n");
  for (const BadRow& bad : summary.bad_rows) {
    absl::StrAppend(&text, "  row ", bad.row, ": ", bad.field, " ", bad.description, "\n");
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
  return absl::StrCat(text, "\n", SummaryText(solved.response.summary));
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
  if (written.ok()) std::cerr << SummaryText(solved.response.summary);
  return written;
}

}  // namespace

absl::Status SolveData(const DataOptions& data, const CommonOptions& options, const Solver& solver, const Scene& scene,
                       const DemandFields& demand) {
  const absl::StatusOr<std::string> text = ReadText(data.file);
  if (!text.ok()) return text.status();
  const absl::StatusOr<CsvTable> table = ParseCsvTable(*text, data.file == "-" ? "standard input" : data.file);
  if (!table.ok()) return table.status();
  absl::StatusOr<int64_t> rows = static_cast<int64_t>(table->columns.front().size());
  if (options.format == Format::kText) rows = RowsOfTable(options, *rows);
  if (!rows.ok()) return rows.status();
  const absl::StatusOr<std::vector<std::string>> columns = FullColumns(scene, data.columns);
  if (!columns.ok()) return columns.status();
  Solved solved = {.setup = {.scene = scene,
                             .fields = table->header,
                             .columns = columns->empty() ? DefaultColumns(scene) : *columns,
                             .demand = demand}};
  if (absl::Status status = Solve(*table, solver, solved); !status.ok()) return status;
  return Write(solved, options, static_cast<size_t>(*rows));
}

}  // namespace ricochet::cli
