#include "client/cli/audit_rows.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "client/cli/input/audit_data.h"
#include "client/cli/input/scene_input.h"
#include "client/cli/io/csv_row.h"
#include "client/cli/io/output.h"
#include "client/cli/report/audit_plot.h"
#include "client/cli/report/audit_report.h"
#include "client/cli/terminal/interrupt.h"
#include "client/cli/terminal/progress.h"
#include "client/cli/text/json_text.h"
#include "core/audit/audit_scene.h"
#include "core/audit/input_scene.h"
#include "core/base/counted.h"
#include "core/base/try.h"
#include "proto/wire/audit.h"
#include "proto/wire/engine.h"

namespace ricochet::cli {
namespace {

// The summary names this many invalid rows.
constexpr size_t kNamedRows = 8;

// A row as the writers of the formats take it.
struct Row {
  int64_t index;
  int64_t line;  // The line of the file.
  const AuditReport& report;
  std::string reason;  // Why it is invalid; empty if it is valid.
};

struct Ending {
  AuditSummary summary;
  EngineInfo engine;
  std::string first_invalid;  // The first invalid rows in words.
};

std::string Complaint(const Row& row) {
  return absl::StrCat("  row ", row.index, " (line ", row.line, "): ", AuditComplaint(row.report, row.reason), "\n");
}

std::string SummaryText(const Ending& ending) {
  return absl::StrCat(AuditSummaryText(ending.summary), ending.first_invalid);
}

// Returns the report as the members of an object of JSON. An invalid row has no numbers, but a reason.
std::string Members(const Row& row) {
  if (row.reason.empty()) {
    const std::string json = JsonOf(ToProto(row.report));
    return json.substr(1, json.size() - 2);
  }
  std::string json = R"("regime":"REGIME_INVALID","admissible":null,"invalid_reason":)";
  AppendJson(row.reason, json);
  return json;
}

// Makes the text of the audit in one of its formats. The summary is at the end of text and JSON, and on standard error
// for the others. JSON has the members of an AuditBatchResponse one after the other, as if one call had answered all
// rows.
class Writer {
 public:
  Writer(Format format, const Scene& scene, bool list)
      : format_(format), directions_(TangentialDirections(scene.system)), list_(list) {}

  std::string Begin() const {
    if (format_ == Format::kText) return list_ ? "Rows that are not admissible\n" : "";
    if (format_ == Format::kJson) return "{\"reports\":[";
    if (format_ == Format::kJsonLines) return "";
    return absl::StrCat("index,", AuditCsvRow(AuditReport(), directions_).Names(), ",invalid_reason\n");
  }

  std::string RowText(const Row& row) const {
    if (format_ == Format::kText) return list_ && !row.report.admissible ? Complaint(row) : "";
    if (format_ == Format::kJson) return absl::StrCat(row.index == 0 ? "\n{" : ",\n{", Members(row), "}");
    if (format_ == Format::kJsonLines) return absl::StrCat("{\"index\":", row.index, ",", Members(row), "}\n");
    // A reason may have commas.
    return absl::StrCat(row.index, ",", AuditCsvRow(row.report, directions_).Values(), ",",
                        row.reason.empty() ? "" : CsvQuoted(row.reason), "\n");
  }

  const char* WhereAllAre() const {
    return format_ == Format::kText ? "--list names all" : "the output says why each is invalid";
  }

  std::string End(const Ending& ending) const {
    if (format_ == Format::kText && list_) return absl::StrCat("\n", AuditSummaryText(ending.summary));
    if (format_ == Format::kText) return SummaryText(ending);
    if (format_ == Format::kJson) {
      AuditBatchResponse rest;
      rest.summary = ending.summary;
      return absl::StrCat("\n],\"summary\":", JsonOf(ToProto(rest).summary()),
                          ",\"engine\":", JsonOf(ToProto(ending.engine)), "}\n");
    }
    std::cerr << SummaryText(ending);
    return "";
  }

 private:
  Format format_;
  size_t directions_;
  bool list_;
};

// Says why an audit calls a row invalid. `scene` has the inputs of the rows.
std::string WhyInvalidIn(audit::InputScene& scene, const AuditRows& rows, size_t row) {
  if (std::string cell = WhyInvalid(rows, row); !cell.empty()) return cell;
  std::optional<SceneContact> contact;
  const std::vector<Violation> violations = scene.SetRow(row, contact);
  if (!violations.empty()) return absl::StrCat(violations[0].field, " ", violations[0].description);
  return "the contact cannot have this velocity before the impact, a number exceeds the largest double, or the audit "
         "takes too many steps";
}

// Replaces the places of columns and inputs in an error by the names of the table's columns.
absl::Status ByColumns(const AuditRows& rows, const absl::Status& status) {
  std::string message = absl::StrReplaceAll(status.message(), {{"columns.", "column "}});
  for (size_t i = rows.inputs.size(); i > 0; --i) {
    const std::string place = absl::StrCat("inputs[", i - 1, "]"),
                      column = absl::StrCat("column ", rows.inputs[i - 1].path);
    message = absl::StrReplaceAll(
        message, {{absl::StrCat(place, ".path"), column}, {absl::StrCat(place, ".values"), column}, {place, column}});
  }
  return {status.code(), message};
}

// Audits one part of the table after the other.
class Auditor {
 public:
  Auditor(const Solver& solver, const Scene& scene, const AuditDataOptions& data, const Writer& writer, Output& output)
      : solver_(solver), scene_(scene), data_(data), writer_(writer), output_(output) {}

  absl::Status Audit(const AuditRows& rows) {
    absl::StatusOr<AuditBatchResponse> response =
        solver_.AuditBatch({.scene = scene_, .columns = rows.columns, .inputs = rows.inputs});
    if (!response.ok()) return ByColumns(rows, response.status());
    if (response->reports.size() != rows.lines.size()) {
      return absl::DataLossError(
          absl::StrCat("the server answered ", response->reports.size(), " rows of ", rows.lines.size()));
    }
    std::string text = ending_.summary.rows == 0 ? writer_.Begin() : "";
    audit::InputScene of_rows(scene_, rows.inputs);
    for (size_t i = 0; i < rows.lines.size(); ++i) {
      const AuditReport& report = response->reports[i];
      const bool is_invalid = report.regime == Regime::kInvalid;
      const Row row{ending_.summary.rows, rows.lines[i], report, is_invalid ? WhyInvalidIn(of_rows, rows, i) : ""};
      if (is_invalid && named_++ < kNamedRows) ending_.first_invalid += Complaint(row);
      if (!data_.picture.file.empty()) plot_.Add(report);
      audit::Add(row.index, report, ending_.summary);
      text += writer_.RowText(row);
    }
    ending_.engine = std::move(response->engine);
    return output_.Write(text);
  }

  absl::Status Finish() {
    if (named_ > kNamedRows) {
      absl::StrAppend(&ending_.first_invalid, "  and ", Counted(named_ - kNamedRows, "more invalid row"), "; ",
                      writer_.WhereAllAre(), "\n");
    }
    if (absl::Status status = output_.Write(writer_.End(ending_)); !status.ok()) return status;
    if (absl::Status status = output_.Commit(); !status.ok()) return status;
    if (!data_.picture.file.empty()) {
      if (absl::Status status = DrawPicture(plot_.Make(), data_.picture); !status.ok()) return status;
    }
    const int64_t bad = ending_.summary.rows - ending_.summary.admissible;
    if (!data_.strict || bad == 0) return absl::OkStatus();
    return absl::FailedPreconditionError(absl::StrCat(bad, " of ", ending_.summary.rows, " rows are not admissible"));
  }

  int64_t rows() const { return ending_.summary.rows; }

 private:
  const Solver& solver_;
  const Scene& scene_;
  const AuditDataOptions& data_;
  const Writer& writer_;
  Output& output_;
  AuditPlot plot_;
  Ending ending_;
  size_t named_ = 0;
};

// The rows of one call with so many columns. A solver that does not tell its limits refuses what is too much.
size_t RowsOfACall(const Solver& solver, size_t columns) {
  const absl::StatusOr<InfoResponse> info = solver.Info({});
  int64_t most = info.ok() ? std::min(kMostAuditRows, info->limits.max_audit_rows) : kMostAuditRows;
  if (info.ok() && info->server_limits.has_value()) {
    // A quarter of a message is left for the scene.
    const int64_t bytes_of_columns = info->server_limits->max_message_bytes / 4 * 3;
    most = std::min(most, bytes_of_columns / static_cast<int64_t>(columns * sizeof(double)));
  }
  return static_cast<size_t>(std::max<int64_t>(most, 1));
}

absl::Status AuditAll(AuditTable& table, int64_t size, const AuditDataOptions& data, bool rows_to_terminal,
                      size_t rows_of_a_call, Auditor& auditor) {
  const Interrupt interrupt;
  Progress progress(rows_to_terminal, "rows");
  bool is_first = true;
  while (true) {
    RICOCHET_TRY(AuditRows rows, table.Next(rows_of_a_call));
    // Without rows there is still one call, which reports the errors of the scene.
    if (rows.lines.empty() && !is_first) break;
    is_first = false;
    if (data.uncertainty_m_s.has_value()) {
      rows.columns.velocity_uncertainty_m_s.assign(rows.lines.size(), *data.uncertainty_m_s);
    }
    if (absl::Status status = auditor.Audit(rows); !status.ok()) return status;
    if (interrupt.token().stop_requested()) return absl::CancelledError("the audit was stopped by its caller");
    // The part of the file that was read gives an estimate of the number of all rows.
    const double part = size > 0 ? static_cast<double>(table.bytes()) / static_cast<double>(size) : 1.0;
    progress.Update(auditor.rows(),
                    std::max(auditor.rows(), static_cast<int64_t>(static_cast<double>(auditor.rows()) / part)));
  }
  Progress::Erase();
  return auditor.Finish();
}

}  // namespace

absl::Status AuditData(const AuditDataOptions& data, const CommonOptions& options, const Solver& solver,
                       const Scene& scene) {
  const bool is_standard = data.file == "-";
  std::ifstream file;
  int64_t size = 0;
  if (!is_standard) {
    RICOCHET_TRY(file, OpenToRead(data.file));
    std::error_code unknown;
    const auto bytes = std::filesystem::file_size(data.file, unknown);
    if (!unknown) size = static_cast<int64_t>(bytes);
  }
  std::istream& stream = is_standard ? std::cin : static_cast<std::istream&>(file);
  absl::StatusOr<AuditTable> table =
      AuditTable::Open(stream, is_standard ? "standard input" : data.file, scene, data.skipped_columns);
  if (absl::Status read = CheckWholeRead(stream, data.file); !read.ok()) return read;
  if (!table.ok()) return table.status();
  if (data.uncertainty_m_s.has_value() && table->has_uncertainty()) {
    return absl::InvalidArgumentError("--uncertainty cannot be combined with a column velocity_uncertainty_m_s");
  }
  RICOCHET_TRY(Output output, Output::Open(options.output));
  const Writer writer(options.format, scene, data.list);
  Auditor auditor(solver, scene, data, writer, output);
  const bool has_rows = data.list || options.format != Format::kText;
  const absl::Status audited = AuditAll(*table, size, data, has_rows && options.output.empty(),
                                        RowsOfACall(solver, table->columns() + 1), auditor);
  const absl::Status read = CheckWholeRead(stream, data.file);
  return read.ok() ? audited : read;
}

}  // namespace ricochet::cli
