#include <CLI/App.hpp>
#include <memory>
#include <optional>
#include <string>

#include "absl/strings/str_cat.h"
#include "client/cli/explore/impact_page.h"
#include "client/cli/input/certificate_report.h"
#include "client/cli/input/demand_input.h"
#include "client/cli/input/derivative_input.h"
#include "client/cli/input/file_option.h"
#include "client/cli/input/make_solver.h"
#include "client/cli/input/scene_input.h"
#include "client/cli/input/short_name.h"
#include "client/cli/io/output.h"
#include "client/cli/io/output_format.h"
#include "client/cli/plot/picture_input.h"
#include "client/cli/program.h"
#include "client/cli/report/derivatives_report.h"
#include "client/cli/report/plan_report.h"
#include "client/cli/report/solve_plot.h"
#include "client/cli/report/solve_report.h"
#include "client/cli/solve_data.h"
#include "client/cli/text/number_input.h"
#include "core/base/try.h"
#include "core/rows/column.h"
#include "proto/wire/requests.h"

namespace ricochet::cli {
namespace {

constexpr char kExample[] = R"(Example: the elastic pendulum of Lubarda (2009), sec. 4.
  $ ricochet solve --a 0.3 --b 1 --mu 0.1 --energetic 1
  Rebound: slip reverses at the end of compression; the contact parts if e > 0.
  Admissible.

  Coefficients
    Newton      (velocities, -v+/v-)     0.707107
    Poisson     (normal impulses)         1.41421
  ...
--data FILE.csv solves many impacts, one on each line. Its header names fields of the scene, by path or shorter, as the
axes of a sweep do; `ricochet sweep --axis ?` lists them. Cells are separated by commas and may stand in double quotes;
numbers have a decimal point, and angles may be in degrees, 45deg. Text prints a summary and the first rows; csv and
json have all rows, and csv prints the summary on standard error. A row that lacks a number, or breaks a rule, is
INVALID and the first have their reasons; the others are still solved.
CSV has one row with every number of the outcome, named by its path. Instead it has one row for each state with
--history, for each sample with --force-history, for each effect with --explain, for each number with --certified, and
for each derivative with --derivatives. It is one table, so that these options exclude each other and --both-ends.
Exit codes: 0 done, 2 wrong input, 42 failed, 75 try again.)";

struct SolveOptions {
  CommonOptions common;
  SceneOptions scene;
  DemandOptions demand;
  bool explain = false;
  bool plan_only = false;
  std::string history;
  std::string force_history;
  std::string certified;
  bool strict = false;
  bool both_ends = false;
  DerivativeOptions derivatives;
  PictureOptions picture;
  std::string html;
  DataOptions data;
};

// True for the options that draw the impact.
bool Draws(const SolveOptions& options) { return !options.picture.file.empty() || !options.html.empty(); }

std::string Text(const Outcome& outcome, bool surface_moves, const SolveOptions& options) {
  std::string text = SolveText(outcome, surface_moves);
  if (outcome.certificate.has_value()) text += CertificateText(*outcome.certificate);
  if (!outcome.derivatives.empty()) text += DerivativesText(outcome.derivatives);
  if (options.explain) absl::StrAppend(&text, "\n", PlanText(outcome.plan));
  return text;
}

std::string Csv(const Outcome& outcome, const SolveOptions& options) {
  if (outcome.certificate.has_value()) return CertificateCsv(*outcome.certificate);
  if (!outcome.derivatives.empty()) return DerivativesCsv(outcome.derivatives);
  if (options.explain) return PlanCsv(outcome.plan);
  if (!options.force_history.empty()) return ForceHistoryCsv(outcome);
  return options.history.empty() ? SolveCsv(outcome) : HistoryCsv(outcome);
}

// True for the options that ask for more than the numbers of one outcome.
bool AsksForMore(const SolveOptions& options) {
  return !options.history.empty() || !options.force_history.empty() || !options.certified.empty() || Draws(options) ||
         options.both_ends || options.derivatives.any();
}

absl::Status CheckTable(const SolveOptions& options) {
  return CheckOneTable(options.common.format, {{"--history", !options.history.empty()},
                                               {"--force-history", !options.force_history.empty()},
                                               {"--explain", options.explain},
                                               {"--certified", !options.certified.empty()},
                                               {"--derivatives", options.derivatives.any()},
                                               {"--both-ends", options.both_ends}});
}

// Prints only the plan.
absl::Status RunPlan(const SolveOptions& options, const Solver& solver, const Scene& scene,
                     const DemandFields& demand) {
  if (AsksForMore(options) || options.strict) {
    return absl::InvalidArgumentError(
        "--plan-only cannot be combined with --history, --force-history, --certified, --strict, --both-ends, "
        "--derivatives, --plot or --html");
  }
  RICOCHET_TRY(const PlanResponse response, solver.Plan({.scene = scene, .demand = demand}));
  return WriteAnswer(
      options.common, response, [&] { return PlanText(response.plan); }, [&] { return PlanCsv(response.plan); });
}

// Solves the rows of a table.
absl::Status RunData(const SolveOptions& options, const Solver& solver, const Scene& scene,
                     const DemandFields& demand) {
  if (AsksForMore(options) || options.explain || options.plan_only) {
    return absl::InvalidArgumentError(
        "--data cannot be combined with --history, --force-history, --certified, --plot, --html, --explain, "
        "--both-ends, --derivatives or --plan-only");
  }
  DataOptions data = options.data;
  data.strict = options.strict;
  return SolveData(data, options.common, solver, scene, demand);
}

absl::Status RunSolve(const SolveOptions& options) {
  if (absl::Status status = CheckPicture(options.picture); !status.ok()) return status;
  RICOCHET_TRY(const std::unique_ptr<Solver> solver, MakeSolver(options.common));
  RICOCHET_TRY(const Scene scene, ReadScene(options.scene));
  RICOCHET_TRY(const DemandFields demand, ReadDemand(options.demand));
  if (!options.data.file.empty()) return RunData(options, *solver, scene, demand);
  if (!options.data.columns.empty() || !options.data.skipped_columns.empty()) {
    return absl::InvalidArgumentError("--column and --skip-column need --data FILE.csv");
  }
  if (options.plan_only) return RunPlan(options, *solver, scene, demand);
  if (absl::Status status = CheckTable(options); !status.ok()) return status;
  SolveRequest request{
      .scene = scene, .inadmissible_is_error = options.strict, .demand = demand, .both_ends = options.both_ends};
  RICOCHET_TRY(request.certified_digits, ReadCertifiedDigits(options.certified));
  RICOCHET_TRY(request.derivatives, ReadDerivatives(options.derivatives, scene, Columns(scene)));
  if (!options.force_history.empty()) {
    RICOCHET_TRY(request.force_intervals, ParseCount(options.force_history, "--force-history", kMostIntervals));
  }
  if (!options.history.empty()) {
    RICOCHET_TRY(request.history_intervals, ParseCount(options.history, "--history", kMostIntervals));
  }
  RICOCHET_TRY(const SolveResponse response, solver->Solve(request));
  if (absl::Status still = RequireVelocity(scene); !still.ok()) return still;
  absl::Status written = WriteAnswer(
      options.common, response, [&] { return Text(response.outcome, scene.surface_velocity.has_value(), options); },
      [&] { return Csv(response.outcome, options); });
  if (!written.ok()) return written;
  if (!options.html.empty()) {
    if (absl::Status page = WriteFile(options.html, FinishedPage(*solver, request, response)); !page.ok()) return page;
  }
  if (options.picture.file.empty()) return absl::OkStatus();
  return DrawPicture(SolvePlot(*solver, request, response), options.picture);
}

}  // namespace

void AddSolve(CLI::App& app, Command& command) {
  const auto [sub, options] = AddCommand<SolveOptions>(
      app, "solve", "Compute one impact: velocities, impulses, coefficients, works", kExample, RunSolve, command);
  AddSceneOptions(*sub, options->scene);
  AddMechanismOptions(*sub, options->scene);
  sub->add_flag("--both-ends", options->both_ends,
                "Also print the impact with no coordinate of the mechanism held, and how far the two are apart");
  AddDerivativeOptions(*sub, "numbers of the outcome", options->derivatives);
  sub->add_flag("--thresholds", options->derivatives.thresholds,
                "Also print how far each number of --by can move before the impact takes another course");
  sub->add_option("--history", options->history, "Also print the states at N + 1 evenly spaced normal impulses")
      ->type_name("N");
  sub->add_option("--force-history", options->force_history,
                  "Also print the forces at N + 1 evenly spaced times; needs a normal spring in the scene")
      ->type_name("N");
  sub->add_flag("--explain", options->explain, "Also print the plan: which effects are simulated or left out, and why");
  sub->add_flag("--plan-only", options->plan_only, "Print only the plan, without computing the impact");
  AddDemandOptions(*sub, options->demand);
  AddCertifiedOption(*sub, options->certified);
  sub->add_flag("--strict", options->strict,
                "Fail if the outcome is inadmissible or has no end; with --data, if that or an invalid row "
                "occurs, after writing all");
  AddPictureOptions(*sub, "velocities and forces over impulse or time, and in space also the slip,", options->picture);
  AddHtmlOption(*sub, "the pictures of `ricochet explore`", options->html);
  MarkFile(
      FileUse::kRead,
      sub->add_option("--data", options->data.file,
                      "Many impacts, one on each line; the header names fields of the scene; - for standard input"))
      ->type_name("FILE.csv");
  AddRepeatable(*sub, "--skip-column", options->data.skipped_columns, "A column of the data to leave out; repeatable")
      ->type_name("NAME");
  AddList(*sub, "--column", options->data.columns,
          "Fields of the outcome to give for --data [the contact's velocity after and the impulse]")
      ->type_name("COLUMN,...");
  AddConnectionOptions(*sub, options->common.connection);
  AddOutputOptions(*sub, options->common, kRowFormats);
}

}  // namespace ricochet::cli
