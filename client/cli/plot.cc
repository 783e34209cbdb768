#include <CLI/App.hpp>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/cli/input/file_option.h"
#include "client/cli/io/output.h"
#include "client/cli/plot/picture_input.h"
#include "client/cli/program.h"
#include "client/cli/sweep/sweep_file.h"
#include "client/cli/sweep/sweep_plot.h"
#include "core/base/try.h"

namespace ricochet::cli {
namespace {

constexpr char kExample[] =
    R"(Example: the picture of a sweep that was computed before.
  $ ricochet sweep --a 0.3 --b 1 --energetic 1 --regime -o friction.npy \
      --axis friction.kinetic_coefficient=lin:0:0.4:1000 \
      --column coefficients.newton
  $ ricochet plot friction.npy
  friction.svg
The picture has the bytes of the one that ricochet sweep --regime --plot draws.
Exit codes: 0 done, 2 wrong input, 42 the picture could not be drawn.)";

struct PlotOptions {
  std::string file;
  std::vector<std::string> columns;
  PictureOptions picture;
};

// Returns the name of the file with the ending .svg in place of its own.
std::string DefaultPicture(const std::string& file) {
  return std::filesystem::path(file).replace_extension(".svg").string();
}

absl::Status RunPlot(PlotOptions options) {
  const bool is_default = options.picture.file.empty();
  if (is_default) options.picture.file = DefaultPicture(options.file);
  if (absl::Status status = CheckPicture(options.picture); !status.ok()) return status;
  RICOCHET_TRY(const SweepTable table, ReadSweepFile(options.file, options.columns));
  if (is_default) {
    if (absl::Status status = UseFile(FileUse::kWritten, "", options.picture.file); !status.ok()) return status;
  }
  absl::StatusOr<Plot> plot = PlotOf(table, options.picture.kind);
  if (!plot.ok()) return {plot.status().code(), absl::StrCat(options.file, ": ", plot.status().message())};
  const bool is_map = !plot->panels.front().map.empty();
  if (absl::Status status = DrawWith(*std::move(plot), options.picture); !status.ok()) return status;
  if (table.regimes.empty()) {
    std::fprintf(stderr, "%s has no regimes, so that %s: ricochet sweep --regime writes them\n", options.file.c_str(),
                 is_map ? "jammed points look like others" : "lines go on where the regime changes");
  }
  return IsStandardOutput(options.picture.file) ? absl::OkStatus() : WriteOutput({}, options.picture.file + "\n");
}

}  // namespace

void AddPlot(CLI::App& app, Command& command) {
  const auto [sub, options] =
      AddCommand<PlotOptions>(app, "plot", "Draw a file that sweep or merge wrote", kExample, RunPlot, command);
  MarkFile(FileUse::kRead,
           sub->add_option("file", options->file, "A sweep as csv, json, jsonl, npy or netcdf; the content says which"))
      ->type_name("FILE")
      ->required();
  MarkFile(FileUse::kWritten,
           sub->add_option("-o,--output", options->picture.file,
                           "The picture; - for SVG on standard output [FILE with the ending .svg]"),
           PictureFormats())
      ->type_name("FILE.svg|.png|.pdf");
  AddList(*sub, "--column", options->columns, "Columns of the file to draw, in this order [all]")
      ->type_name("COLUMN,...");
  AddLookOptions(*sub, options->picture);
  AddAxisOptions(*sub, options->picture);
  AddKindOption(*sub, options->picture);
}

}  // namespace ricochet::cli
