// Maps: a panel whose points are cells of a colour for their value, as gnuplot draws it.

#ifndef RICOCHET_CLIENT_CLI_PLOT_PLOT_MAP_H_
#define RICOCHET_CLIENT_CLI_PLOT_PLOT_MAP_H_

#include <string>
#include <vector>

#include "client/cli/plot/plot_axis.h"
#include "client/cli/plot/plot_scale.h"

namespace ricochet::cli {

struct MapPoint {
  double x = 0.0;
  double y = 0.0;
  double value = 0.0;      // NaN: the point has no value, and its cell is grey.
  bool is_jammed = false;  // Its cell has a colour of its own, and the scale leaves its value out.
};

struct MapCell {
  double left = 0.0;
  double right = 0.0;
  double bottom = 0.0;
  double top = 0.0;
  double value = 0.0;
  bool is_jammed = false;
};

// The names of cells without a colour for their value, in the legend.
inline constexpr char kNoValue[] = "no value or invalid";
inline constexpr char kJammed[] = "jammed (locked)";
inline constexpr char kJamColour[] = "#a6611a";

// Returns those of the names above that cells of these points need.
std::vector<std::string> LegendOfCells(const std::vector<MapPoint>& points);

// Returns the scale of the colours: that of all cells with a value which are not jammed.
Scale ScaleOfCells(const std::vector<MapCell>& cells);

// Returns the cells of points of a grid, row by row from below. The border between two cells is half way between their
// points, on a logarithmic axis by their ratio. Points at or below 0 have no cell on a logarithmic axis.
std::vector<MapCell> CellsOf(const std::vector<MapPoint>& points, bool log_x, bool log_y);

// Appends the data of the cells as blocks that begin with `name`. Values beyond the range of the colours have those of
// its ends. Returns the parts of the command that plots them.
std::vector<std::string> AppendCells(const std::string& name, const std::vector<MapCell>& cells, const AxisRange& range,
                                     std::string& script);

// Appends what the colours mean: the palette, its range, and its scale with the command for its ticks and the quoted
// label. Without a value there is none.
void AppendColours(const Scale& scale, const AxisRange& range, const std::string& ticks, const std::string& label,
                   std::string& script);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_PLOT_PLOT_MAP_H_
