// Maps: a panel whose points are cells of a colour for their value, as gnuplot draws it.

#ifndef RICOCHET_CLIENT_CLI_PLOT_MAP_H_
#define RICOCHET_CLIENT_CLI_PLOT_MAP_H_

#include <string>
#include <vector>

#include "client/cli/plot_axis.h"

namespace ricochet::cli {

struct MapPoint {
  double x = 0.0;
  double y = 0.0;
  double value = 0.0;  // NaN: the point has no value, and its cell is grey.
};

struct MapCell {
  double left = 0.0;
  double right = 0.0;
  double bottom = 0.0;
  double top = 0.0;
  double value = 0.0;
};

// Returns the cells of points of a grid, row by row from below. The border between two cells is half way between their
// points, on a logarithmic axis by their ratio. Points at or below 0 have no cell on a logarithmic axis.
std::vector<MapCell> CellsOf(const std::vector<MapPoint>& points, bool log_x, bool log_y);

// Appends the data of the cells as blocks that begin with `name`. Returns the parts of the command that plots them.
std::vector<std::string> AppendCells(const std::string& name, const std::vector<MapCell>& cells, std::string& script);

// Appends what the colours mean: the palette, its range, and its scale with the ticks and the quoted label.
void AppendColours(const AxisRange& range, const std::string& ticks, const std::string& label, std::string& script);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_PLOT_MAP_H_
