// The options of a picture that the subcommands share: --plot and how it looks.

#ifndef RICOCHET_CLIENT_CLI_PLOT_PICTURE_INPUT_H_
#define RICOCHET_CLIENT_CLI_PLOT_PICTURE_INPUT_H_

#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/cli/plot/plot.h"

namespace CLI {
class App;
}

namespace ricochet::cli {

// Says how a sweep is drawn. kAuto: a whole grid of two axes that both have many values is a map, any other sweep is
// curves.
enum class PlotKind { kAuto, kCurves, kMap };

struct PictureOptions {
  std::string file;  // Empty: no picture is drawn, and all others must be unset.
  std::string title;
  std::string size;
  bool log_x = false;
  bool log_y = false;
  PlotKind kind = PlotKind::kAuto;  // For pictures of sweeps.
};

// Adds --plot, which draws `what`, --title and --size.
void AddPictureOptions(CLI::App& app, const std::string& what, PictureOptions& options);
// Adds --title and --size.
void AddLookOptions(CLI::App& app, PictureOptions& options);
// Adds --logx and --logy, for pictures whose axes are not fixed.
void AddAxisOptions(CLI::App& app, PictureOptions& options);
// Adds --kind, for pictures of sweeps.
void AddKindOption(CLI::App& app, PictureOptions& options);

// Pixels; 0 and 0 mean that the panels choose them.
struct PictureSize {
  int width = 0;
  int height = 0;
};
// Errors: INVALID_ARGUMENT.
absl::StatusOr<PictureSize> SizeOf(const PictureOptions& options);

// Refuses what no picture can have, before anything is computed. Errors: INVALID_ARGUMENT.
absl::Status CheckPicture(const PictureOptions& options);

// Draws the plot under the title, in the size and on the axes that the options ask for.
// Errors: FAILED_PRECONDITION if `plot` is an error or gnuplot is missing, else one of Draw.
absl::Status DrawWith(absl::StatusOr<Plot> plot, const PictureOptions& options);

// Draws the picture of numbers that were written before, so that they are there if the picture fails. Errors: those of
// DrawWith, which say that only the picture is missing.
absl::Status DrawPicture(absl::StatusOr<Plot> plot, const PictureOptions& options);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_PLOT_PICTURE_INPUT_H_
