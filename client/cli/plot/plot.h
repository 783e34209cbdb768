// Plots: curves or maps in panels, which gnuplot draws as a child process.

#ifndef RICOCHET_CLIENT_CLI_PLOT_PLOT_H_
#define RICOCHET_CLIENT_CLI_PLOT_PLOT_H_

#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/cli/plot/plot_axis.h"
#include "client/cli/plot/plot_map.h"

namespace ricochet::cli {

struct Curve {
  std::string title;                              // Empty: the legend leaves the curve out.
  std::vector<std::pair<double, double>> points;  // NaN leaves a gap.
  // This says how gnuplot draws the points, such as "with points pointtype 6". If it is empty, they get a line in the
  // colour and dashes of `look`, and a mark at each point that has no neighbour.
  std::string style;
  // For marks at points that other curves or cells show, this says how the legend draws them; their names come last.
  std::string key_style;
  int look = -1;  // Curves of equal look are drawn alike. -1: the place of the curve in its panel.
};

struct Panel {
  std::string title;
  std::string x_label;
  std::string y_label;
  // On a logarithmic axis points at or below 0 are not drawn, and a line above the panel says how many.
  bool log_x = false;
  bool log_y = false;
  // The scale upwards is that of plot_scale.h: it may leave out a few values far beyond the rest, or be logarithmic.
  bool robust = false;
  bool whole_x = false;         // Values to the right are whole numbers.
  bool equal_scales = false;    // One unit is as long to the right as upwards.
  double y_noise = 0.0;         // Values that differ by no more than this differ by rounding alone.
  std::vector<double> x_marks;  // A vertical dashed line is drawn at each.
  std::vector<double> y_marks;  // A horizontal dashed line is drawn at each.
  std::vector<Curve> curves;
  std::vector<double> x_missing;  // A cross at the lower edge marks each place without a value.
  std::vector<Tick> y_ticks;      // Names in place of numbers upwards; empty: numbers.
  // The points of a grid, which are drawn as coloured cells in place of curves, and what the colours mean.
  std::vector<MapPoint> map;
  std::string map_label;
  // Further commands of gnuplot, each with a line feed, in place of the axes that the panel would choose. They stay in
  // force for the panels that follow.
  std::string settings;
};

struct Plot {
  std::string title;
  std::vector<Panel> panels;
  // The size in pixels; 0: one that suits the number of panels.
  int width = 0;
  int height = 0;
};

// The height in pixels of the letters where each panel has a cell of this size, and their mean width over their height.
double LetterHeight(double cell_width, double cell_height);
inline constexpr double kLetterWidth = 0.62;

// The formats of pictures, which are the endings of their files.
inline std::vector<std::string> PictureFormats() { return {"svg", "png", "pdf"}; }

// Returns the bytes of a whole picture in one of PictureFormats.
// Errors: INVALID_ARGUMENT for numbers beyond 1e300, FAILED_PRECONDITION if gnuplot is not installed, INTERNAL if it
// fails.
absl::StatusOr<std::string> DrawAs(const Plot& plot, const std::string& format);

// Draws to the file `path`, which appears complete or not at all. Its ending says the format; standard output
// gets an SVG.
// Errors: those of DrawAs, and those of the system.
absl::Status Draw(const Plot& plot, const std::string& path);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_PLOT_PLOT_H_
