#include "proto/wire/audit.h"

#include <CLI/App.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "client/cli/audit_rows.h"
#include "client/cli/input/file_option.h"
#include "client/cli/input/make_solver.h"
#include "client/cli/input/scene_input.h"
#include "client/cli/plot/picture_input.h"
#include "client/cli/program.h"
#include "client/cli/report/audit_plot.h"
#include "client/cli/report/audit_report.h"
#include "client/cli/text/number_input.h"
#include "core/base/try.h"

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
and velocity_uncertainty_m_s; in space also tangential_2_m_s and tangential_2_after_m_s. All velocities of the system
after, as `ricochet scene columns` lists them, may replace that of the contact: rates_after_rad_s[0], or
bodies_after[0].linear_m_s[0], bodies_after[0].linear_m_s[1] and bodies_after[0].angular_rad_s[0]. Fields of the scene
that differ by row, such as velocity_n_m_s of a body before, replace the columns before and friction. Text prints a
summary; csv and jsonl print a line for each impact, and the summary on standard error; json prints both. A row with a
cell that is no number, or that breaks a rule, is INVALID and has its reason; the others are still audited. Cells are
separated by commas and may stand in double quotes; numbers have a decimal point.
Exit codes: 0 done, 2 wrong input, 42 failed, 75 try again.)";

struct AuditOptions {
  CommonOptions common;
  SceneOptions scene;
  std::optional<std::string> rate, velocity, uncertainty;
  AuditDataOptions data;
};

absl::StatusOr<Observed> ReadObserved(const AuditOptions& options) {
  if (options.rate.has_value()) {
    RICOCHET_TRY(const std::vector<double> rates, ParseNumbers(*options.rate, "--observed-rate"));
    Observed observed;
    observed.emplace<ObservedRates>().values.assign(rates.begin(), rates.end());
    return observed;
  }
  if (!options.velocity.has_value()) {
    return absl::InvalidArgumentError(
        "no observation: give --observed-velocity T,N, --observed-rate X or --data FILE.csv");
  }
  RICOCHET_TRY(const std::vector<double> numbers, ParseNumbers(*options.velocity, "--observed-velocity"));
  return Observed(
      ContactVelocity{.tangential_m_s = {numbers.begin(), numbers.end() - 1}, .normal_m_s = numbers.back()});
}

absl::StatusOr<double> ReadUncertainty(const AuditOptions& options) {
  return options.uncertainty.has_value() ? ParseNumber(*options.uncertainty, "--uncertainty") : 0.0;
}

absl::Status AuditOne(const AuditOptions& options, const Solver& solver, const Scene& scene) {
  RICOCHET_TRY(const Observed observed, ReadObserved(options));
  RICOCHET_TRY(const double uncertainty, ReadUncertainty(options));
  RICOCHET_TRY(const AuditResponse response,
               solver.Audit({.scene = scene, .observed = observed, .velocity_uncertainty_m_s = uncertainty}));
  const size_t directions = TangentialDirections(scene.system);
  absl::Status written = WriteAnswer(
      options.common, response, [&] { return AuditText(response, directions); },
      [&] { return CsvOf({AuditCsvRow(response.report, directions)}); });
  if (!written.ok()) return written;
  if (!options.data.picture.file.empty()) {
    AuditPlot plot;
    plot.Add(response.report);
    if (absl::Status status = DrawPicture(plot.Make(), options.data.picture); !status.ok()) return status;
  }
  if (!options.data.strict || response.report.admissible) return absl::OkStatus();
  return absl::FailedPreconditionError("the observed impact is not admissible");
}

absl::Status AuditMany(const AuditOptions& options, const Solver& solver, const Scene& scene) {
  if (options.rate.has_value() || options.velocity.has_value()) {
    return absl::InvalidArgumentError("--data cannot be combined with --observed-rate or --observed-velocity");
  }
  AuditDataOptions data = options.data;
  if (options.uncertainty.has_value()) {
    RICOCHET_TRY(data.uncertainty_m_s, ReadUncertainty(options));
  }
  return AuditData(data, options.common, solver, scene);
}

absl::Status RunAudit(const AuditOptions& options) {
  if (absl::Status status = CheckPicture(options.data.picture); !status.ok()) return status;
  if (options.data.file.empty() && (options.data.list || !options.data.skipped_columns.empty())) {
    return absl::InvalidArgumentError("--list and --skip-column need --data FILE.csv");
  }
  RICOCHET_TRY(const std::unique_ptr<Solver> solver, MakeSolver(options.common));
  RICOCHET_TRY(const Scene scene, ReadScene(options.scene));
  return options.data.file.empty() ? AuditOne(options, *solver, scene) : AuditMany(options, *solver, scene);
}

}  // namespace

void AddAudit(CLI::App& app, Command& command) {
  const auto [sub, options] = AddCommand<AuditOptions>(
      app, "audit", "What observed impacts imply, and which physical limits they break", kExample, RunAudit, command);
  AddSceneOptions(*sub, options->scene);
  CLI::Option* rate =
      sub->add_option(
             "--observed-rate", options->rate,
             "All velocities of the system after: the rate of a pendulum, those of links or coordinates, or of "
             "each body its linear velocity, then its angular one; m/s and rad/s")
          ->type_name("X[,X...]");
  sub->add_option("--observed-velocity", options->velocity,
                  "Contact velocity after, m/s: tangential (two in space), then normal")
      ->type_name("T[,T2],N")
      ->excludes(rate);
  sub->add_option("--uncertainty", options->uncertainty,
                  "Uncertainty of each component of the contact velocity, m/s [0]")
      ->type_name("X");
  MarkFile(FileUse::kRead,
           sub->add_option("--data", options->data.file,
                           "Many impacts, one on each line; the header names the columns; - for standard input"))
      ->type_name("FILE.csv");
  AddRepeatable(*sub, "--skip-column", options->data.skipped_columns, "A column of the data to leave out; repeatable")
      ->type_name("NAME");
  sub->add_flag("--list", options->data.list,
                "As text, also name each row of the data that is not admissible, and why");
  sub->add_flag("--strict", options->data.strict, "Fail if an impact is not admissible, after writing the answer");
  AddPictureOptions(*sub, "the impulses in the friction cone, and each row beside its limits,", options->data.picture);
  AddConnectionOptions(*sub, options->common.connection);
  AddOutputOptions(*sub, options->common, kRowFormats);
}

}  // namespace ricochet::cli
