#include "client/cli/audit.h"

#include <algorithm>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "client/cli/audit_data.h"
#include "client/cli/audit_report.h"
#include "client/cli/number_input.h"
#include "client/cli/output.h"
#include "client/cli/scene_input.h"
#include "core/contact/reduction.h"
#include "core/study/audit_scene.h"
#include "proto/wire/audit.h"

namespace ricochet::cli {
namespace {

constexpr char kExample[] =
    R"(Example: a pendulum is reported to rebound at 0.9 of its rate, which friction does not allow.
  $ ricochet audit --a 0.3 --b 1 --mu 0.1 --observed-rate 0.9
  Inadmissible:
    the energetic coefficient exceeds 1 by 0.272792
  ...
--data FILE.csv audits many impacts at one contact. Its header names the columns: tangential_m_s and normal_m_s before
the impact (default: those of the scene), tangential_after_m_s, normal_after_m_s, friction (default: that of the scene)
and velocity_uncertainty_m_s; in space also tangential_2_m_s and tangential_2_after_m_s. For a pendulum or a linkage,
rates_after_rad_s[0] and so on, one for each link, may replace the velocity after. Text prints a summary; csv prints one
row for each impact, and the summary on standard error; json prints both. A bad row is flagged INVALID; the others are
still audited.
Exit codes: 0 done, 2 wrong input, 42 failed, 75 try again.)";

struct AuditOptions {
  CommonOptions common;
  SceneOptions scene;
  std::optional<std::string> rate, velocity, uncertainty;
  std::string data;
  std::vector<std::string> skipped_columns;
};

absl::StatusOr<std::vector<double>> ParseNumbers(const std::string& text, const std::string& what) {
  std::vector<double> numbers;
  for (const auto part : absl::StrSplit(text, ',')) {
    const absl::StatusOr<double> number = ParseNumber(std::string(part), what);
    if (!number.ok()) return number.status();
    numbers.push_back(*number);
  }
  return numbers;
}

absl::StatusOr<Observed> ReadObserved(const AuditOptions& options) {
  if (options.rate.has_value()) {
    const absl::StatusOr<std::vector<double>> rates = ParseNumbers(*options.rate, "--observed-rate");
    if (!rates.ok()) return rates.status();
    return Observed(ObservedRates{{rates->begin(), rates->end()}});
  }
  if (!options.velocity.has_value()) {
    return absl::InvalidArgumentError(
        "no observation: give --observed-velocity T,N, --observed-rate X or --data FILE.csv");
  }
  const absl::StatusOr<std::vector<double>> numbers = ParseNumbers(*options.velocity, "--observed-velocity");
  if (!numbers.ok()) return numbers.status();
  return Observed(
      ContactVelocity{.tangential_m_s = {numbers->begin(), numbers->end() - 1}, .normal_m_s = numbers->back()});
}

absl::StatusOr<double> ReadUncertainty(const AuditOptions& options) {
  return options.uncertainty.has_value() ? ParseNumber(*options.uncertainty, "--uncertainty") : 0.0;
}

absl::Status AuditOne(const AuditOptions& options, const Solver& solver, const Scene& scene) {
  const absl::StatusOr<Observed> observed = ReadObserved(options);
  if (!observed.ok()) return observed.status();
  const absl::StatusOr<double> uncertainty = ReadUncertainty(options);
  if (!uncertainty.ok()) return uncertainty.status();
  const absl::StatusOr<AuditResponse> response =
      solver.Audit({.scene = scene, .observed = *observed, .velocity_uncertainty_m_s = *uncertainty});
  if (!response.ok()) return response.status();
  const size_t directions = TangentialDirections(scene.system);
  switch (options.common.format) {
    case Format::kText:
      return WriteOutput(options.common, AuditText(*response, directions));
    case Format::kJson: {
      const absl::StatusOr<std::string> json = Json(ToProto(*response));
      return json.ok() ? WriteOutput(options.common, *json) : json.status();
    }
    case Format::kCsv:
      break;
  }
  return WriteOutput(options.common,
                     absl::StrCat(AuditCsvHeader(directions), "\n", AuditCsvRow(response->report, directions), "\n"));
}

absl::StatusOr<AuditColumns> ReadData(const AuditOptions& options) {
  if (options.rate.has_value() || options.velocity.has_value()) {
    return absl::InvalidArgumentError("--data cannot be combined with --observed-rate or --observed-velocity");
  }
  const absl::StatusOr<std::string> text = ReadText(options.data);
  if (!text.ok()) return text.status();
  absl::StatusOr<AuditColumns> columns = ParseAuditData(
      *text, options.data == "-" ? std::string("standard input") : options.data, options.skipped_columns);
  if (!columns.ok() || !options.uncertainty.has_value()) return columns;
  const absl::StatusOr<double> uncertainty = ReadUncertainty(options);
  if (!uncertainty.ok()) return uncertainty.status();
  if (!columns->velocity_uncertainty_m_s.empty()) {
    return absl::InvalidArgumentError("--uncertainty cannot be combined with a column velocity_uncertainty_m_s");
  }
  columns->velocity_uncertainty_m_s.assign(RowCount(*columns), *uncertainty);
  return columns;
}

using Receiver = absl::FunctionRef<absl::Status(size_t first, AuditBatchResponse& part)>;

// Audits `columns` in parts of at most kMostAuditRows rows, and passes each answer to `receive`.
absl::StatusOr<AuditSummary> AuditRows(const Solver& solver, const Scene& scene, const AuditColumns& columns,
                                       Receiver receive) {
  AuditSummary summary;
  const size_t rows = RowCount(columns);
  size_t first = 0;
  do {  // Without rows there is still one call, which reports the errors of the scene.
    const size_t end = std::min(rows, first + static_cast<size_t>(kMostAuditRows));
    absl::StatusOr<AuditBatchResponse> response =
        solver.AuditBatch({.scene = scene, .columns = SomeRows(columns, first, end)});
    if (!response.ok()) return response.status();
    if (response->reports.size() != end - first) {
      return absl::DataLossError(
          absl::StrCat("the server answered ", response->reports.size(), " rows of ", end - first));
    }
    for (size_t i = first; i < end; ++i) {
      audit::Add(static_cast<int64_t>(i), response->reports[i - first], summary);
    }
    if (absl::Status status = receive(first, *response); !status.ok()) return status;
    first = end;
  } while (first < rows);
  return summary;
}

absl::Status WriteSummary(const Solver& solver, const Scene& scene, const AuditColumns& columns, Output& output) {
  const absl::StatusOr<AuditSummary> summary =
      AuditRows(solver, scene, columns, [](size_t, const AuditBatchResponse&) { return absl::OkStatus(); });
  return summary.ok() ? output.Write(AuditSummaryText(*summary)) : summary.status();
}

// Writes one line for each row; the summary goes to standard error.
absl::Status WriteCsv(const Solver& solver, const Scene& scene, const AuditColumns& columns, Output& output) {
  const size_t directions = TangentialDirections(scene.system);
  const absl::StatusOr<AuditSummary> summary =
      AuditRows(solver, scene, columns, [&](size_t first, const AuditBatchResponse& part) {
        std::string text = first == 0 ? absl::StrCat("index,", AuditCsvHeader(directions), "\n") : "";
        for (const AuditReport& report : part.reports) {
          absl::StrAppend(&text, first++, ",", AuditCsvRow(report, directions), "\n");
        }
        return output.Write(text);
      });
  if (summary.ok()) std::cerr << AuditSummaryText(*summary);
  return summary.status();
}

// Writes all rows as one response, as if one call had answered them.
absl::Status WriteJson(const Solver& solver, const Scene& scene, const AuditColumns& columns, Output& output) {
  AuditBatchResponse whole;
  const absl::StatusOr<AuditSummary> summary =
      AuditRows(solver, scene, columns, [&whole](size_t, AuditBatchResponse& part) {
        std::move(part.reports.begin(), part.reports.end(), std::back_inserter(whole.reports));
        whole.engine = std::move(part.engine);
        return absl::OkStatus();
      });
  if (!summary.ok()) return summary.status();
  whole.summary = *summary;
  const absl::StatusOr<std::string> json = Json(ToProto(whole));
  return json.ok() ? output.Write(*json) : json.status();
}

absl::Status WriteRows(const AuditOptions& options, const Solver& solver, const Scene& scene,
                       const AuditColumns& columns, Output& output) {
  switch (options.common.format) {
    case Format::kText:
      break;
    case Format::kJson:
      return WriteJson(solver, scene, columns, output);
    case Format::kCsv:
      return WriteCsv(solver, scene, columns, output);
  }
  return WriteSummary(solver, scene, columns, output);
}

absl::Status AuditMany(const AuditOptions& options, const Solver& solver, const Scene& scene) {
  const absl::StatusOr<AuditColumns> columns = ReadData(options);
  if (!columns.ok()) return columns.status();
  absl::StatusOr<Output> output = Output::Open(options.common.output);
  if (!output.ok()) return output.status();
  if (absl::Status status = WriteRows(options, solver, scene, *columns, *output); !status.ok()) return status;
  return output->Commit();
}

absl::Status RunAudit(const AuditOptions& options) {
  const absl::StatusOr<std::unique_ptr<Solver>> solver = MakeSolver(options.common);
  if (!solver.ok()) return solver.status();
  const absl::StatusOr<Scene> scene = ReadScene(options.scene);
  if (!scene.ok()) return scene.status();
  return options.data.empty() ? AuditOne(options, **solver, *scene) : AuditMany(options, **solver, *scene);
}

}  // namespace

void AddAudit(CLI::App& app, Command& command) {
  CLI::App* sub = app.add_subcommand("audit", "What observed impacts imply, and which physical limits they break");
  const auto options = std::make_shared<AuditOptions>();
  AddSceneOptions(*sub, options->scene);
  CLI::Option* rate =
      sub->add_option("--observed-rate", options->rate,
                      "Angular velocity after, rad/s: of a pendulum, or of each link of a linkage, separated by commas")
          ->type_name("X[,X...]");
  sub->add_option("--observed-velocity", options->velocity,
                  "Contact velocity after, m/s: tangential (two in space), then normal")
      ->type_name("T[,T2],N")
      ->excludes(rate);
  sub->add_option("--uncertainty", options->uncertainty,
                  "Uncertainty of each component of the contact velocity, m/s [0]")
      ->type_name("X");
  sub->add_option("--data", options->data,
                  "Many impacts, one on each line; the header names the columns; - for standard input")
      ->type_name("FILE.csv");
  sub->add_option("--skip-column", options->skipped_columns, "A column of the data to leave out; repeatable")
      ->type_name("NAME")
      ->allow_extra_args(false);
  AddServerOptions(*sub, options->common);
  AddOutputOptions(*sub, options->common);
  sub->footer(kExample);
  sub->callback([options, &command] { command = [options] { return RunAudit(*options); }; });
}

}  // namespace ricochet::cli
