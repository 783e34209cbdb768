// Plots: curves in panels side by side, which gnuplot draws as a child process.

#ifndef RICOCHET_CLIENT_CLI_PLOT_H_
#define RICOCHET_CLIENT_CLI_PLOT_H_

#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace ricochet::cli {

struct Curve {
  std::string title;                              // Empty: the legend leaves the curve out.
  std::vector<std::pair<double, double>> points;  // NaN leaves a gap.
  // How gnuplot draws the points, such as "with points pointtype 6". Empty: a line, or a mark if there is one point.
  std::string style;
};

struct Panel {
  std::string title;
  std::string x_label;
  std::string y_label;
  bool log_x = false;
  std::vector<double> x_marks;  // A vertical dashed line is drawn at each.
  std::vector<Curve> curves;
  // Further commands of gnuplot, each with a line feed, that replace what the panel has by default. They stay in force
  // for the panels that follow.
  std::string settings;
};

struct Plot {
  std::string title;
  std::vector<Panel> panels;
  // The size in pixels; 0: one that suits the number of panels.
  int width = 0;
  int height = 0;
};

// Errors: INVALID_ARGUMENT unless the name ends in .svg or .png.
absl::Status CheckPlotPath(const std::string& path);

// Returns the commands for gnuplot; `terminal` is "svg" or "png".
std::string PlotScript(const Plot& plot, const std::string& terminal, const std::string& path);

// Returns the text of an SVG file. Errors: those of Draw.
absl::StatusOr<std::string> DrawSvg(const Plot& plot);

// Draws to the file `path`, which appears complete or not at all.
// Errors: FAILED_PRECONDITION if gnuplot is not installed, INTERNAL if it fails.
absl::Status Draw(const Plot& plot, const std::string& path);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_PLOT_H_
