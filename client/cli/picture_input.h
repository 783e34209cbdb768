// The options of a picture that the subcommands share: --plot and how it looks.

#ifndef RICOCHET_CLIENT_CLI_PICTURE_INPUT_H_
#define RICOCHET_CLIENT_CLI_PICTURE_INPUT_H_

#include <CLI/App.hpp>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/cli/plot.h"

namespace ricochet::cli {

struct PictureOptions {
  std::string file;  // Empty: no picture is drawn, and all others must be unset.
  std::string title;
  std::string size;
  bool log_x = false;
  bool log_y = false;
};

// Adds --plot, which draws `what`, --title and --size.
void AddPictureOptions(CLI::App& app, const std::string& what, PictureOptions& options);
// Adds --logx and --logy, for pictures whose axes are not fixed.
void AddAxisOptions(CLI::App& app, PictureOptions& options);

// Refuses what no picture can have, before anything is computed. Errors: INVALID_ARGUMENT.
absl::Status CheckPicture(const PictureOptions& options);

// Draws the plot under the title, in the size and on the axes that the options ask for.
// Call it after the numbers were written, so that they are there if the picture fails. An error says that only the
// picture is missing; it is FAILED_PRECONDITION if `plot` is an error or gnuplot is missing, else one of Draw.
absl::Status DrawPicture(absl::StatusOr<Plot> plot, const PictureOptions& options);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_PICTURE_INPUT_H_
