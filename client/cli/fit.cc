#include "proto/wire/fit.h"

#include <CLI/App.hpp>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "client/cli/input/file_option.h"
#include "client/cli/input/fit_data.h"
#include "client/cli/input/make_solver.h"
#include "client/cli/input/scene_input.h"
#include "client/cli/plot/picture_input.h"
#include "client/cli/program.h"
#include "client/cli/report/fit_report.h"
#include "client/cli/terminal/interrupt.h"
#include "client/cli/text/number_input.h"
#include "core/base/try.h"

namespace ricochet::cli {
namespace {

constexpr char kExample[] =
    R"(Example: the friction of a rod from its measured impacts.
  $ ricochet fit --scene rod.textproto --data rod.csv --unknown mu=0.2
  chi2 ... with ... degrees of freedom, probability ...
  ...

The header of the data names numbers of the scene that differ by row, numbers of the outcome that were measured, and
NAME.sigma for the standard deviation of NAME; --sigma gives one for all rows. Numbers of the scene are exact without
one. An empty cell was not measured. Names may be short where they mean one number. The interval of an unknown holds
95 %, by profile likelihood; "not seen" means that the data do not tell the unknown by itself.
CSV has one row for each unknown, with --rows one for each row of the data, and the summary is on standard error; json
has all.
Exit codes: 0 done, 2 wrong input, 42 failed, 75 try again, 130 interrupted.)";

struct FitOptions {
  CommonOptions common;
  SceneOptions scene;
  FitDataOptions data;
  std::optional<std::string> loss, starts, iterations;
  bool rows = false;
  bool strict = false;
  PictureOptions picture;
};

absl::Status ReadLoss(const std::string& text, FitRequest& request) {
  const size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  if (name != "squares" && name != "huber" && name != "cauchy") {
    return InputError("--loss", text, "be squares, huber, cauchy, huber=SCALE or cauchy=SCALE");
  }
  request.loss = name == "huber" ? FitLoss::kHuber : name == "cauchy" ? FitLoss::kCauchy : FitLoss::kSquares;
  if (equals == std::string::npos) return absl::OkStatus();
  RICOCHET_TRY(request.loss_scale, ParseNumber(text.substr(equals + 1), "--loss"));
  return absl::OkStatus();
}

absl::Status ReadSearch(const FitOptions& options, FitRequest& request) {
  if (options.loss.has_value()) {
    if (absl::Status status = ReadLoss(*options.loss, request); !status.ok()) return status;
  }
  if (options.starts.has_value()) {
    RICOCHET_TRY(const int64_t starts, ParseCount(*options.starts, "--starts", kMostFitStarts));
    request.starts = static_cast<int32_t>(starts);
  }
  if (!options.iterations.has_value()) return absl::OkStatus();
  RICOCHET_TRY(const int64_t iterations, ParseCount(*options.iterations, "--iterations", kMostFitIterations));
  request.max_iterations = static_cast<int32_t>(iterations);
  return absl::OkStatus();
}

// Errors: INVALID_ARGUMENT for an option whose part of the answer the format does not have.
absl::Status CheckFormat(const FitOptions& options) {
  const Format format = options.common.format;
  if (options.rows && format != Format::kCsv) return absl::InvalidArgumentError("--rows needs --format csv");
  if (options.data.region.empty() || format == Format::kJson || !options.picture.file.empty()) return absl::OkStatus();
  return absl::InvalidArgumentError(
      "--region needs --format json or --plot FILE: the tables have no border of a region");
}

absl::Status RunFit(const FitOptions& options) {
  if (absl::Status status = CheckFormat(options); !status.ok()) return status;
  if (absl::Status status = CheckPicture(options.picture); !status.ok()) return status;
  RICOCHET_TRY(const std::unique_ptr<Solver> solver, MakeSolver(options.common));
  RICOCHET_TRY(const Scene scene, ReadScene(options.scene));
  RICOCHET_TRY(FitRequest request, ReadFit(options.data, scene));
  if (absl::Status status = ReadSearch(options, request); !status.ok()) return status;
  const Interrupt interrupt;
  const absl::StatusOr<FitResponse> response = solver->Fit(request, {.stop = interrupt.token()});
  if (!response.ok()) return InTheTable(request, response.status());
  absl::Status written = WriteAnswer(
      options.common, *response, [&] { return FitText(request, *response); },
      [&] { return options.rows ? FitRowsCsv(request, *response) : FitCsv(*response); });
  if (!written.ok()) return written;
  if (options.common.format == Format::kCsv) std::fputs(FitSummaryText(*response).c_str(), stderr);
  if (!options.picture.file.empty()) {
    if (absl::Status status = DrawPicture(FitPlot(request, *response), options.picture); !status.ok()) return status;
  }
  if (!options.strict || !response->refused) return absl::OkStatus();
  return absl::FailedPreconditionError("the data refuse the physics or the stated errors");
}

}  // namespace

void AddFit(CLI::App& app, Command& command) {
  const auto [sub, options] = AddCommand<FitOptions>(
      app, "fit", "What measured impacts tell about numbers of the scene, and how well", kExample, RunFit, command);
  AddSceneOptions(*sub, options->scene);
  MarkFile(FileUse::kRead,
           sub->add_option("--data", options->data.file,
                           "Measured impacts, one on each line; the header names the columns; - for standard input"))
      ->type_name("FILE.csv")
      ->required();
  AddRepeatable(*sub, "--unknown", options->data.unknowns,
                "A number of the scene to find, and where to start [the scene's own number]; repeatable")
      ->type_name("NAME[=START]")
      ->required();
  AddRepeatable(*sub, "--bound", options->data.bounds, "Bounds of an unknown; either may be left out; repeatable")
      ->type_name("NAME=LOW:HIGH");
  AddRepeatable(*sub, "--sigma", options->data.sigmas, "The standard deviation of the error of a column; repeatable")
      ->type_name("NAME=SIGMA");
  AddRepeatable(*sub, "--skip-column", options->data.skipped_columns, "A column of the data to leave out; repeatable")
      ->type_name("NAME");
  sub->add_option("--loss", options->loss,
                  "What residuals cost: squares, or huber or cauchy beyond SCALE sigmas [squares]")
      ->type_name("LOSS[=SCALE]");
  sub->add_option("--starts", options->starts, "Searches; further ones spread over the bounds [1]")->type_name("N");
  sub->add_option("--iterations", options->iterations, "The most iterations of a search [100]")->type_name("N");
  AddList(*sub, "--region", options->data.region, "Two unknowns whose 95 % region is wanted")->type_name("NAME,NAME");
  sub->add_flag("--rows", options->rows, "As csv, print the rows of the data with their residuals");
  sub->add_flag("--strict", options->strict, "Fail if the data refuse the physics, after writing the answer");
  AddPictureOptions(*sub, "data over model, the residuals, the profile of each unknown and the region,",
                    options->picture);
  AddConnectionOptions(*sub, options->common.connection);
  AddOutputOptions(*sub, options->common, kMessageFormats);
}

}  // namespace ricochet::cli
