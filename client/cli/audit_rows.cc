#include "client/cli/audit_rows.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <memory>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/cli/audit_data.h"
#include "client/cli/audit_plot.h"
#include "client/cli/audit_report.h"
#include "client/cli/csv_table.h"
#include "client/cli/interrupt.h"
#include "client/cli/json/json_text.h"
#include "client/cli/output.h"
#include "client/cli/progress.h"
#include "core/contact/reduction.h"
#include "core/study/audit_scene.h"
#include "proto/wire/audit.h"
#include "proto/wire/engine.h"

namespace ricochet::cli {
namespace {

// The summary names this many invalid rows.
constexpr size_t kNamedRows = 8;

// What the writers of the formats are given of a row.
struct Row {
  int64_t index;
  int64_t line;  // Of the file.
  const AuditReport& report;
  std::string reason;  // Why it is invalid; empty if it is valid.
};

struct Ending {
  AuditSummary summary;
  EngineInfo engine;
  std::string first_invalid;  // The first invalid rows in words.
};

class Writer {
 public:
  virtual ~Writer() = default;
  virtual std::string Begin() { return ""; }
  virtual std::string RowText(const Row& row) = 0;
  virtual std::string End(const Ending& ending) = 0;
};

std::string Complaint(const Row& row) {
  return absl::StrCat("  row ", row.index, " (line ", row.line, "): ", AuditComplaint(row.report, row.reason), "\n");
}

std::string SummaryText(const Ending& ending) {
  return absl::StrCat(AuditSummaryText(ending.summary), ending.first_invalid);
}

class TextWriter : public Writer {
 public:
  explicit TextWriter(bool list) : list_(list) {}
  std::string Begin() override { return list_ ? "Rows that are not admissible\n" : ""; }
  std::string RowText(const Row& row) override {
    return list_ && !row.report.admissible ? Complaint(row) : std::string();
  }
  std::string End(const Ending& ending) override {
    return list_ ? absl::StrCat("\n", AuditSummaryText(ending.summary)) : SummaryText(ending);
  }

 private:
  bool list_;
};

// The last cell of a row is its reason, in quotes because it may have commas. The summary goes to standard error.
class CsvWriter : public Writer {
 public:
  explicit CsvWriter(size_t directions) : directions_(directions) {}
  std::string Begin() override { return absl::StrCat("index,", AuditCsvHeader(directions_), ",invalid_reason\n"); }
  std::string RowText(const Row& row) override {
    const std::string reason = row.reason.empty() ? "" : CsvQuoted(row.reason);
    return absl::StrCat(row.index, ",", AuditCsvRow(row.report, directions_), ",", reason, "\n");
  }
  std::string End(const Ending& ending) override {
    std::cerr << SummaryText(ending);
    return std::string();
  }

 private:
  size_t directions_;
};

// Returns the report as the members of an object of JSON. An invalid row has no numbers, but a reason.
std::string Members(const Row& row) {
  if (row.reason.empty()) {
    const std::string json = JsonOf(ToProto(row.report));
    return json.substr(1, json.size() - 2);
  }
  std::string json = R"("regime":"REGIME_INVALID","admissible":false,"invalid_reason":)";
  AppendJson(row.reason, json);
  return json;
}

// Writes the members of an AuditBatchResponse one after the other, as if one call had answered all rows.
class JsonWriter : public Writer {
 public:
  std::string Begin() override { return "{\"reports\":["; }
  std::string RowText(const Row& row) override {
    return absl::StrCat(row.index == 0 ? "\n{" : ",\n{", Members(row), "}");
  }
  std::string End(const Ending& ending) override {
    AuditBatchResponse rest;
    rest.summary = ending.summary;
    return absl::StrCat("\n],\"summary\":", JsonOf(ToProto(rest).summary()),
                        ",\"engine\":", JsonOf(ToProto(ending.engine)), "}\n");
  }
};

// Writes an object on a line for each row. The summary goes to standard error.
class JsonLinesWriter : public Writer {
 public:
  std::string RowText(const Row& row) override {
    return absl::StrCat("{\"index\":", row.index, ",", Members(row), "}\n");
  }
  std::string End(const Ending& ending) override {
    std::cerr << SummaryText(ending);
    return "";
  }
};

std::unique_ptr<Writer> MakeWriter(Format format, const Scene& scene, bool list) {
  if (format == Format::kText) return std::make_unique<TextWriter>(list);
  if (format == Format::kJson) return std::make_unique<JsonWriter>();
  if (format == Format::kJsonLines) return std::make_unique<JsonLinesWriter>();
  return std::make_unique<CsvWriter>(TangentialDirections(scene.system));
}

// Audits one part of the table after the other.
class Auditor {
 public:
  Auditor(const Solver& solver, const Scene& scene, const AuditDataOptions& data, Writer& writer, Output& output)
      : solver_(solver), scene_(scene), data_(data), writer_(writer), output_(output) {}

  absl::Status Audit(const AuditRows& rows) {
    absl::StatusOr<AuditBatchResponse> response = solver_.AuditBatch({.scene = scene_, .columns = rows.columns});
    if (!response.ok()) return response.status();
    if (response->reports.size() != rows.lines.size()) {
      return absl::DataLossError(
          absl::StrCat("the server answered ", response->reports.size(), " rows of ", rows.lines.size()));
    }
    std::string text = ending_.summary.rows == 0 ? writer_.Begin() : "";
    for (size_t i = 0; i < rows.lines.size(); ++i) {
      const AuditReport& report = response->reports[i];
      const bool is_invalid = report.regime == Regime::kInvalid;
      const Row row{ending_.summary.rows, rows.lines[i], report, is_invalid ? WhyInvalid(rows, i) : ""};
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
      absl::StrAppend(&ending_.first_invalid, "  and ", named_ - kNamedRows, " more invalid rows; --list names all\n");
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
  Writer& writer_;
  Output& output_;
  AuditPlot plot_;
  Ending ending_;
  size_t named_ = 0;
};

absl::Status AuditAll(AuditTable& table, int64_t size, const AuditDataOptions& data, bool rows_to_terminal,
                      Auditor& auditor) {
  const Interrupt interrupt;
  Progress progress(rows_to_terminal, "rows");
  bool is_first = true;
  while (true) {
    AuditRows rows = table.Next(static_cast<size_t>(kMostAuditRows));
    // Without rows there is still one call, which reports the errors of the scene.
    if (rows.lines.empty() && !is_first) break;
    is_first = false;
    if (data.uncertainty_m_s.has_value()) {
      rows.columns.velocity_uncertainty_m_s.assign(rows.lines.size(), *data.uncertainty_m_s);
    }
    if (absl::Status status = auditor.Audit(rows); !status.ok()) return status;
    if (interrupt.token().stop_requested()) return absl::CancelledError("the audit was stopped by its caller");
    // How many rows there will be is told by the part of the file that was read.
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
    std::error_code unknown;
    if (!std::filesystem::is_directory(data.file, unknown)) file.open(data.file, std::ios::binary);
    if (!file.is_open()) {
      return absl::InvalidArgumentError(
          absl::StrCat("cannot read ", data.file, ": ", std::strerror(errno == 0 ? EISDIR : errno)));
    }
    const auto bytes = std::filesystem::file_size(data.file, unknown);
    if (!unknown) size = static_cast<int64_t>(bytes);
  }
  absl::StatusOr<AuditTable> table = AuditTable::Open(is_standard ? std::cin : static_cast<std::istream&>(file),
                                                      is_standard ? "standard input" : data.file, data.skipped_columns);
  if (!table.ok()) return table.status();
  if (data.uncertainty_m_s.has_value() && table->has_uncertainty()) {
    return absl::InvalidArgumentError("--uncertainty cannot be combined with a column velocity_uncertainty_m_s");
  }
  absl::StatusOr<Output> output = Output::Open(options.output);
  if (!output.ok()) return output.status();
  const std::unique_ptr<Writer> writer = MakeWriter(options.format, scene, data.list);
  Auditor auditor(solver, scene, data, *writer, *output);
  const bool has_rows = data.list || options.format != Format::kText;
  return AuditAll(*table, size, data, has_rows && options.output.empty(), auditor);
}

}  // namespace ricochet::cli
