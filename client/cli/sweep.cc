#include "proto/wire/sweep.h"

#include <CLI/App.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/cli/input/axis_input.h"
#include "client/cli/input/demand_input.h"
#include "client/cli/input/file_option.h"
#include "client/cli/input/make_solver.h"
#include "client/cli/input/scene_input.h"
#include "client/cli/input/shard_input.h"
#include "client/cli/input/short_name.h"
#include "client/cli/io/output.h"
#include "client/cli/io/used_files.h"
#include "client/cli/plot/picture_input.h"
#include "client/cli/program.h"
#include "client/cli/report/invalid_points.h"
#include "client/cli/sweep/shard.h"
#include "client/cli/sweep/sweep_output.h"
#include "client/cli/sweep/sweep_plot.h"
#include "client/cli/terminal/interrupt.h"
#include "client/cli/terminal/progress.h"
#include "client/cli/text/number_input.h"
#include "core/base/try.h"
#include "core/rows/column.h"
#include "core/scene/field.h"

namespace ricochet::cli {
namespace {

constexpr char kExample[] =
    R"(Example: Newton's coefficient over the angle for five frictions, fig. 4 of Lubarda (2009).
  $ ricochet sweep --a 0.6 --b 0.8 --energetic 1 \
      --axis friction.kinetic_coefficient=0.1,1/3,0.5,2/3,1 \
      --axis pendulum.phi_rad=lin:0.01:1.5707963267948966:400 \
      --column coefficients.newton --plot fig4.svg
  index   friction.kinetic_coefficient   pendulum.phi_rad   coefficients.newton
  0                                0.1               0.01                     0
  ...
The last axis runs fastest. --axis ? and --column ? list all axes and columns, of the scene if one is given. The end of
a name will do if it means one of them: mu, phi, newton, energy_change; coefficients.* are all that start so.
Points that break a rule are INVALID and have no numbers; standard error counts them by reason.
Exit codes: 0 done, also with invalid points, 2 wrong input, 42 failed, 75 try again, 130 interrupted.)";

struct SweepOptions {
  CommonOptions common;
  SceneOptions scene;
  std::string request;
  std::vector<std::string> axes;
  std::vector<std::string> columns;
  std::string range;
  DemandOptions demand;
  bool zip = false;
  bool regime = false;
  bool summary_only = false;
  bool strict = false;
  PictureOptions picture;
  std::string threads;
  bool resume = false;
  bool fan_out = false;
  ShardInput shard;
  std::vector<std::string> arguments;  // The command line of this run.
};

absl::StatusOr<SweepRequest> RequestFromFile(const SweepOptions& options) {
  if (options.scene.any() || !options.axes.empty() || !options.columns.empty() || !options.range.empty() ||
      options.zip || options.regime || options.demand.any()) {
    return absl::InvalidArgumentError(
        "--request cannot be combined with the flags of a scene, of accuracy and effects, --axis, --column, --range, "
        "--zip or --regime: put them into the file");
  }
  v1::SweepRequest proto;
  if (absl::Status status = ReadMessage(options.request, proto); !status.ok()) return status;
  return FromProto(proto);
}

// Returns the three coefficients and the first velocity of the system, or that of the contact if the system has none.
std::vector<std::string> DefaultColumns(const Scene& scene) {
  const std::vector<std::string> known = Columns(scene);
  std::vector<std::string> columns = {"coefficients.newton"};
  for (const char* phase : {"coefficients.poisson", "coefficients.energetic"}) {
    if (std::find(known.begin(), known.end(), phase) != known.end()) columns.emplace_back(phase);
  }
  for (const char* motion :
       {"rates_after_rad_s[0]", "bodies_after[0].linear_m_s[0]", "contact_velocity_after.normal_m_s"}) {
    if (std::find(known.begin(), known.end(), motion) == known.end()) continue;
    columns.emplace_back(motion);
    break;
  }
  return columns;
}

absl::StatusOr<SweepRequest> RequestFromFlags(const SweepOptions& options) {
  SweepRequest request;
  RICOCHET_TRY(request.grid.scene, ReadScene(options.scene));
  for (const std::string& text : options.axes) {
    RICOCHET_TRY(Axis axis, ParseAxis(text, request.grid.scene));
    request.grid.axes.push_back(std::move(axis));
  }
  request.grid.combination = options.zip ? Combination::kZip : Combination::kProduct;
  RICOCHET_TRY(std::vector<std::string> columns, FullColumns(request.grid.scene, options.columns));
  request.columns = columns.empty() ? DefaultColumns(request.grid.scene) : std::move(columns);
  request.with_regime = options.regime;
  RICOCHET_TRY(request.demand, ReadDemand(options.demand));
  if (options.range.empty()) return request;
  if (absl::Status wrong = ReadRange(options.range, request); !wrong.ok()) return wrong;
  return request;
}

// True if what the sweep has written can be gone on with: rows or lines in a file. A table shows only some points, and
// a summary none, so that they are written when they are complete.
bool IsResumable(const SweepOptions& options) {
  const CommonOptions& common = options.common;
  const bool has_rows = common.format != Format::kText && common.format != Format::kNetcdf;
  return !common.output.empty() && has_rows && !options.summary_only && !IsDevice(common.output);
}

absl::Status CheckResume(const SweepOptions& options) {
  // A shard resumes whether --resume is given or not.
  if (!options.resume || options.shard.any() || IsResumable(options)) return absl::OkStatus();
  return absl::InvalidArgumentError(
      "--resume needs -o FILE as csv, json, jsonl or npy, without --summary-only: only rows in a file can be gone on "
      "with");
}

// Passes the chunks of one sweep on to the output, the picture and the progress bar.
class Receiver {
 public:
  Receiver(const SweepRequest& request, const SweepOptions& options, SweepOutput output)
      : options_(&options),
        with_regime_(request.with_regime),
        output_(std::move(output)),
        doubtful_(request),
        progress_(StreamsRows(options.common)) {
    if (!options.picture.file.empty()) plot_.emplace(request, options.picture.kind);
  }

  // The points that the output does not have yet.
  SweepRequest Remaining(SweepRequest request) const {
    request.first_index = output_.next_index();
    return plot_.has_value() ? SweepPlot::Wanted(std::move(request)) : request;
  }

  absl::Status Add(SweepChunk& chunk) {
    if (absl::Status status = output_.Join(chunk); !status.ok()) return status;
    progress_.Update(chunk.points_done, chunk.points_total);
    doubtful_.Add(chunk);
    if (chunk.summary.has_value() && !chunk.summary->elapsed_s.has_value()) {
      chunk.summary->elapsed_s = progress_.Seconds();
    }
    if (plot_.has_value()) {
      plot_->Add(chunk);
      if (!with_regime_) {
        chunk.regimes.clear();
        chunk.statuses.clear();
      }
    }
    return output_.Write(chunk);
  }

  // Computes the points that an earlier run has written once more for the picture, up to what it can show.
  absl::Status DrawEarlier(const Solver& solver, SweepRequest request, std::stop_token stop) {
    if (!plot_.has_value() || output_.next_index() <= request.first_index) return absl::OkStatus();
    request.end_index = output_.next_index();
    for (const absl::StatusOr<SweepChunk>& chunk :
         solver.Sweep(SweepPlot::Wanted(std::move(request)), {.stop = std::move(stop)})) {
      if (!chunk.ok()) return chunk.status();
      plot_->Add(*chunk);
      if (!plot_->fits()) break;
    }
    return absl::OkStatus();
  }

  absl::Status Commit() {
    absl::Status written = output_.Commit();
    if (written.ok()) std::fputs(doubtful_.Text().c_str(), stderr);
    return written;
  }

  // Errors: FAILED_PRECONDITION if the run is strict and a point is not as it should be.
  absl::Status CheckStrictly() const { return options_->strict ? doubtful_.CheckStrictly() : absl::OkStatus(); }

  // Draws the picture, if one is wanted, after the output was committed.
  absl::Status Picture() const {
    return plot_.has_value() ? DrawPicture(plot_->Make(), options_->picture) : absl::OkStatus();
  }

  SweepOutput& output() { return output_; }

 private:
  const SweepOptions* options_;
  bool with_regime_;  // The output has the regimes, too.
  SweepOutput output_;
  DoubtfulPoints doubtful_;
  std::optional<SweepPlot> plot_;
  Progress progress_;
};

absl::Status ReceiveAll(SweepStream stream, Receiver& receiver) {
  for (absl::StatusOr<SweepChunk>& chunk : stream) {
    if (!chunk.ok()) return chunk.status();
    if (absl::Status status = receiver.Add(*chunk); !status.ok()) return status;
  }
  return receiver.Commit();
}

absl::Status ReceiveInto(SweepOutput output, const Solver& solver, const SweepRequest& request,
                         const SweepOptions& options, std::stop_token stop) {
  Receiver receiver(request, options, std::move(output));
  absl::Status status = receiver.DrawEarlier(solver, request, stop);
  if (status.ok()) status = ReceiveAll(solver.Sweep(receiver.Remaining(request), {.stop = std::move(stop)}), receiver);
  if (status.ok()) {
    absl::Status drawn = receiver.Picture();
    return drawn.ok() ? receiver.CheckStrictly() : drawn;
  }
  receiver.output().LeaveForResume(status, ResumeCommand(options.arguments));
  return status;
}

absl::Status Receive(const Solver& solver, const SweepRequest& request, const SweepOptions& options,
                     std::stop_token stop) {
  RICOCHET_TRY(SweepOutput output, IsResumable(options)
                                       ? SweepOutput::OpenPartial(request, options.common, options.resume)
                                       : SweepOutput::Open(request, options.common, options.summary_only));
  return ReceiveInto(std::move(output), solver, request, options, std::move(stop));
}

// Computes one shard, unless that was done before.
absl::Status ReceiveShard(const Solver& solver, const SweepRequest& request, const SweepOptions& options,
                          std::stop_token stop) {
  RICOCHET_TRY(const ShardNumber number, FindShard(options.shard));
  RICOCHET_TRY(const SweepShard shard, MakeShard(request, number, options.common.output));
  for (const std::string& path : {shard.path, shard.manifest_path()}) {
    if (absl::Status status = UseFile(FileUse::kWritten, "", path); !status.ok()) return status;
  }
  RICOCHET_TRY(const bool complete, IsComplete(shard));
  if (complete) {
    std::fprintf(stderr, "%s is complete\n", shard.path.c_str());
    return absl::OkStatus();
  }
  RICOCHET_TRY(SweepOutput output, SweepOutput::OpenShard(shard));
  return ReceiveInto(std::move(output), solver, shard.part, options, std::move(stop));
}

// Returns nothing for an empty text: the solver then chooses the number of threads.
absl::StatusOr<std::optional<int>> ReadThreads(const std::string& text) {
  constexpr int64_t kMost = 1024;
  if (text.empty()) return std::nullopt;
  const absl::StatusOr<int64_t> threads = ParseCount(text, "--threads");
  if (!threads.ok() || *threads < 1 || *threads > kMost) {
    return InputError("--threads", text, absl::StrCat("be a whole number from 1 to ", kMost));
  }
  return static_cast<int>(*threads);
}

absl::Status RunSweep(const SweepOptions& options) {
  if (AsksForNames(options.axes)) return ListNames(options.common, options.scene, FieldPaths);
  if (AsksForNames(options.columns)) return ListNames(options.common, options.scene, Columns);
  const Format format = options.common.format;
  if (options.summary_only && (format == Format::kNpy || format == Format::kNetcdf)) {
    return absl::InvalidArgumentError("--summary-only needs --format text, json, jsonl or csv: a summary is no array");
  }
  if (absl::Status status = CheckResume(options); !status.ok()) return status;
  if (absl::Status status = CheckPicture(options.picture); !status.ok()) return status;
  RICOCHET_TRY(const std::optional<int> threads, ReadThreads(options.threads));
  // This comes before the solver, which starts threads.
  const Interrupt interrupt;
  RICOCHET_TRY(const std::unique_ptr<Solver> solver,
               MakeSolver(options.common, threads, Limits::None(), options.fan_out));
  RICOCHET_TRY(const SweepRequest request,
               options.request.empty() ? RequestFromFlags(options) : RequestFromFile(options));
  if (request.grid.axes.empty()) {
    std::fputs("The sweep is one point, because it has no --axis PATH=VALUES; --axis ? lists the paths.\n", stderr);
  }
  if (options.shard.any()) return ReceiveShard(*solver, request, options, interrupt.token());
  return Receive(*solver, request, options, interrupt.token());
}

void AddGridOptions(CLI::App& sub, SweepOptions& options) {
  AddRepeatable(sub, "--axis", options.axes,
                "A field that varies: a list 0.1,1/3,0.5 or lin:START:STOP:COUNT or log:START:STOP:COUNT; an angle may "
                "be in degrees, 45deg; may be repeated")
      ->type_name("PATH=VALUES")
      ->group("Grid");
  sub.add_flag("--zip", options.zip, "Advance all axes together instead of combining their values")->group("Grid");
  AddList(sub, "--column", options.columns,
          "Fields of the outcome to compute [the three coefficients and rates_after_rad_s[0]]")
      ->type_name("COLUMN,...")
      ->group("Grid");
  sub.add_flag("--regime", options.regime,
               "Also print the regime of every point, and its status: OK, INADMISSIBLE, or why it has no numbers")
      ->group("Grid");
  sub.add_option("--range", options.range, "Only the points FIRST <= index < END")
      ->type_name("FIRST:END")
      ->group("Grid");
  MarkFile(FileUse::kRead,
           sub.add_option("--request", options.request,
                          "A whole ricochet.v1.SweepRequest as JSON or textproto; - for standard input"))
      ->type_name("FILE")
      ->group("Grid");
}

}  // namespace

void AddSweep(CLI::App& app, std::vector<std::string> arguments, Command& command) {
  const auto [sub, options] =
      AddCommand<SweepOptions>(app, "sweep", "Compute many impacts over a grid", kExample, RunSweep, command);
  options->arguments = std::move(arguments);
  AddSceneOptions(*sub, options->scene);
  AddGridOptions(*sub, *options);
  AddDemandOptions(*sub, options->demand);
  sub->add_flag("--summary-only", options->summary_only, "Compute every point, but print only the summary");
  sub->add_flag("--strict", options->strict,
                "Fail if a point is invalid, inadmissible or has no end, after writing the answer");
  sub->add_option("--threads", options->threads,
                  "Compute with at most N threads, which changes no result [the number of cores]; not with --server")
      ->type_name("N");
  AddPictureOptions(*sub, "curves over the last axis, or a map of two axes,", options->picture);
  AddAxisOptions(*sub, options->picture);
  AddKindOption(*sub, options->picture);
  AddConnectionOptions(*sub, options->common.connection);
  sub->add_flag("--fan-out", options->fan_out,
                "Let all servers of --server A,B,... compute the sweep together, a range of points each at a time");
  AddOutputOptions(*sub, options->common, kSweepFormats);
  sub->add_flag("--resume", options->resume,
                "Go on with FILE.part, which a run with -o FILE as csv, json, jsonl or npy left when it was ended");
  AddShardOptions(*sub, options->shard);
}

}  // namespace ricochet::cli
