// The curves of a panel, as gnuplot draws them on the axes of the panel.

#ifndef RICOCHET_CLIENT_CLI_PLOT_PLOT_CURVES_H_
#define RICOCHET_CLIENT_CLI_PLOT_PLOT_CURVES_H_

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "client/cli/plot/plot.h"
#include "client/cli/plot/plot_axis.h"
#include "client/cli/plot/plot_scale.h"

namespace ricochet::cli {

inline constexpr AxisRange kNoRange{1.0, 10.0};

// The ranges that the axes of a panel show.
struct Axes {
  bool log_x = false;
  bool log_y = false;
  AxisRange x = kNoRange;
  AxisRange y = kNoRange;
  AxisRange z = kNoRange;  // The colours of a map span this range.
  Scale scale;           // The scale of a map's colours, else upwards; without values where the panel has a fixed one.
  int64_t left_out = 0;  // Points that a logarithmic axis cannot show.

  bool Shows(const std::pair<double, double>& point) const {
    return std::isfinite(point.first) && std::isfinite(point.second) && !(log_x && point.first <= 0.0) &&
           !(log_y && point.second <= 0.0);
  }
  // Return where a shown value is on its axis: 0 at the lower end, 1 at the upper end.
  double Across(double value) const { return PlaceOn(x, log_x, value); }
  double Height(double value) const { return PlaceOn(y, log_y, value); }

 private:
  static double PlaceOn(const AxisRange& range, bool log, double value) {
    if (!log) return (value - range.lower) / (range.upper - range.lower);
    return (std::log(value) - std::log(range.lower)) / (std::log(range.upper) - std::log(range.lower));
  }
};

// Returns a gnuplot string, in which only the quote is a special character. What is not UTF-8 becomes U+FFFD.
std::string Quoted(const std::string& text);

// Appends the data of the curves as blocks that begin with `prefix`. Returns the parts of the command that plots them:
// a line in the look of its curve with marks at points that have no neighbour, ribbons where later curves lie upon it,
// and triangles where it is beyond an end of the scale; crosses where there is no value; and names for the legend.
std::vector<std::string> AppendCurves(const std::string& prefix, const Panel& panel, const Axes& axes,
                                      std::string& script);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_PLOT_PLOT_CURVES_H_
