#include "proto/wire/cost.h"

#include <CLI/App.hpp>
#include <chrono>
#include <memory>
#include <string>
#include <utility>
#include <variant>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "client/cli/input/file_option.h"
#include "client/cli/input/make_solver.h"
#include "client/cli/input/scene_input.h"
#include "client/cli/io/output.h"
#include "client/cli/plot/picture_input.h"
#include "client/cli/program.h"
#include "client/cli/report/cost_page.h"
#include "client/cli/report/cost_picture.h"
#include "client/cli/report/cost_report.h"
#include "client/cli/terminal/interrupt.h"
#include "client/cli/terminal/progress.h"
#include "client/cli/text/number_input.h"
#include "client/cost_reader.h"
#include "core/base/try.h"

namespace ricochet::cli {
namespace {

constexpr char kExample[] = R"(Example: the elastic pendulum of Lubarda (2009), sec. 4, in a second.
  $ ricochet cost --a 0.3 --b 1 --mu 0.1 --energetic 1 --time-limit 1s
13 methods for one impact. The exact answer: certified to 100 digits.
  ...
Every method that can compute the impact is timed and held against the exact answer, on the machine that answers: this
one, or that of --server. Times differ from run to run. docs/cli.md explains the columns.
Exit codes: 0 done, 2 wrong input, 42 failed, 75 try again.)";

struct CostOptions {
  CommonOptions common;
  SceneOptions scene;
  std::string time_limit;
  std::string samples;
  PictureOptions picture;
  std::string html;
};

// Pictures and the page place methods by the error that they make.
absl::Status RefusePictures(const CostOptions& options) {
  for (const auto& [file, name] : {std::pair(options.picture.file, "--plot"), std::pair(options.html, "--html")}) {
    if (file.empty()) continue;
    return absl::InvalidArgumentError(absl::StrCat(
        name, " ", file, ": must be left out, because the errors of the methods for several contacts are not known"));
  }
  return absl::OkStatus();
}

absl::StatusOr<CostRequest> MakeRequest(const CostOptions& options) {
  CostRequest request;
  std::variant<Scene, MultiContactScene> scene;
  if (absl::Status status = ReadAnyScene(options.scene, scene); !status.ok()) return status;
  if (auto* const several = std::get_if<MultiContactScene>(&scene)) {
    if (absl::Status status = RefusePictures(options); !status.ok()) return status;
    request.multi_contact = std::move(*several);
  } else {
    request.scene = std::get<Scene>(std::move(scene));
  }
  if (!options.time_limit.empty()) {
    RICOCHET_TRY(const auto limit, ParseDuration(options.time_limit, "--time-limit"));
    request.time_limit_s = std::chrono::duration<double>(limit).count();
  }
  if (!options.samples.empty()) {
    RICOCHET_TRY(const int64_t samples, ParseCount(options.samples, "--samples", kMostCostSamples));
    request.samples = static_cast<int32_t>(samples);
  }
  return request;
}

absl::Status WritePage(const Scene& scene, const CostChunk& study, const std::string& path) {
  const std::string date = absl::FormatTime("%Y-%m-%d %H:%M UTC", absl::Now(), absl::UTCTimeZone());
  const absl::StatusOr<std::string> page = CostPage(scene, study, date);
  return page.ok() ? WriteFile(path, *page) : page.status();
}

absl::Status RunCost(const CostOptions& options) {
  if (absl::Status status = CheckPicture(options.picture); !status.ok()) return status;
  // This comes before the solver, whose connection starts threads.
  const Interrupt interrupt;
  RICOCHET_TRY(const std::unique_ptr<Solver> solver, MakeSolver(options.common));
  RICOCHET_TRY(const CostRequest request, MakeRequest(options));
  Progress progress(/*rows_to_terminal=*/false, "methods");
  RICOCHET_TRY(const CostChunk study,
               WholeStudy(solver->Cost(request, {.stop = interrupt.token()}),
                          [&](const CostChunk& part) { progress.Update(part.rows_done, part.rows_total); }));
  absl::Status written = WriteAnswer(
      options.common, study, [&] { return CostText(study); }, [&] { return CostCsv(study); });
  if (!written.ok()) return written;
  if (!options.html.empty()) {
    if (absl::Status status = WritePage(request.scene, study, options.html); !status.ok()) return status;
  }
  if (options.picture.file.empty()) return absl::OkStatus();
  const std::string title = absl::StrCat("What accuracy costs: one impact, ", SystemText(request.scene));
  RICOCHET_TRY(const PictureSize size, SizeOf(options.picture));
  return DrawPicture(CostPlot(study, title, size.width, size.height), options.picture);
}

}  // namespace

void AddCost(CLI::App& app, Command& command) {
  const auto [sub, options] =
      AddCommand<CostOptions>(app, "cost", "What accuracy costs in time, method by method", kExample, RunCost, command);
  AddAnySceneOptions(*sub, options->scene);
  sub->add_option("--time-limit", options->time_limit, "Time for the whole study (500ms, 10s, 1m), at most 60 s [3s]")
      ->type_name("TIME");
  sub->add_option("--samples", options->samples, "Samples taken of each time [21]")->type_name("N");
  AddPictureOptions(*sub, "time over error, and error made over error claimed,", options->picture);
  AddHtmlOption(*sub, "tables and pictures", options->html);
  AddConnectionOptions(*sub, options->common.connection);
  AddOutputOptions(*sub, options->common, kMessageFormats);
}

}  // namespace ricochet::cli
