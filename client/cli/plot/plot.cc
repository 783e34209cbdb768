#include "client/cli/plot/plot.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "absl/status/status.h"
#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/cli/io/output.h"
#include "client/cli/io/output_format.h"
#include "client/cli/plot/gnuplot.h"
#include "client/cli/plot/plot_axis.h"
#include "client/cli/plot/plot_curves.h"
#include "client/cli/plot/plot_layout.h"
#include "client/cli/plot/plot_scale.h"
#include "core/base/counted.h"
#include "core/base/decimal.h"

namespace ricochet::cli {
namespace {

constexpr char kGrid[] = "set grid linecolor rgb '#d8d8d8' linewidth 1 linetype 1\n";

std::string Terminal(const std::string& terminal, const Layout& layout) {
  const std::string size = absl::StrCat(layout.width, ",", layout.height);
  const auto font = static_cast<int>(layout.font);
  if (terminal == "svg")
    return absl::StrCat("svg size ", size, " font 'DejaVu Sans,", font, "' rounded background 'white'");
  // Letters of cairo are measured in points, of which 72 are an inch; a pixel is taken as a 96th.
  if (terminal == "png")
    return absl::StrCat("pngcairo size ", size, " font 'DejaVu Sans,", 0.8 * layout.font, "' rounded");
  return absl::StrCat("pdfcairo size ", layout.width / 96.0, "in,", layout.height / 96.0,
                      "in fontscale 1 font 'DejaVu Sans,", 0.75 * layout.font, "' rounded background 'white'");
}

struct Ends {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
  void Add(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
  bool any() const { return least <= most; }
};

// The axes of a map end at its outermost cells, so that cells fill the frame.
Axes AxesOfMap(const Panel& panel, const std::vector<MapCell>& cells) {
  Ends x;
  Ends y;
  for (const MapCell& cell : cells) {
    x.Add(cell.left);
    x.Add(cell.right);
    y.Add(cell.bottom);
    y.Add(cell.top);
  }
  const Scale scale = ScaleOfCells(cells);
  return {.log_x = panel.log_x,
          .log_y = panel.log_y,
          .x = x.any() ? AxisRange{x.least, x.most} : kNoRange,
          .y = y.any() ? AxisRange{y.least, y.most} : kNoRange,
          .z = RangeOf(scale, 0.0, 0.0),
          .scale = scale,
          .left_out = static_cast<int64_t>(panel.map.size() - cells.size())};
}

Scale ScaleOfCurves(const Panel& panel) {
  std::vector<std::vector<double>> groups;
  for (const Curve& curve : panel.curves) {
    if (!curve.key_style.empty()) continue;
    std::vector<double>& group = groups.emplace_back();
    for (const auto& [x, y] : curve.points) {
      if (!panel.log_x || x > 0.0) group.push_back(y);
    }
  }
  return ScaleFor(std::move(groups), panel.log_y);
}

// With equal scales, points in a row would leave the other axis no room.
constexpr double kLeastProportion = 0.4;

void Widen(double least, AxisRange& range) {
  const double missing = std::max(0.0, least - (range.upper - range.lower));
  range.lower -= 0.5 * missing;
  range.upper += 0.5 * missing;
}

Axes AxesOf(const Panel& panel) {
  Axes axes{.log_x = panel.log_x, .log_y = panel.log_y};
  if (panel.robust) {
    axes.scale = ScaleOfCurves(panel);
    axes.log_y = axes.scale.log;
  }
  Ends x;
  Ends y;
  for (const Curve& curve : panel.curves) {
    if (!curve.key_style.empty()) continue;
    for (const auto& point : curve.points) {
      if (axes.Shows(point)) {
        x.Add(point.first);
        y.Add(point.second);
      } else if (std::isfinite(point.first) && std::isfinite(point.second)) {
        ++axes.left_out;
      }
    }
  }
  for (const double missing : panel.x_missing) {
    if (!panel.log_x || missing > 0.0) x.Add(missing);
  }
  for (const double mark : panel.y_marks) {
    if (!axes.log_y || mark > 0.0) y.Add(mark);
  }
  for (const Tick& tick : panel.y_ticks) {
    y.Add(tick.at - 0.6);
    y.Add(tick.at + 0.6);
  }
  // Lines may begin and end at the frame; marks need room.
  const bool needs_room = std::any_of(panel.curves.begin(), panel.curves.end(), [](const Curve& curve) {
    return !curve.style.empty() && curve.key_style.empty();
  });
  if (x.any()) axes.x = RangeFor(x.least, x.most, needs_room ? 0.04 : 0.0, 0.0, axes.log_x);
  const double margin = panel.y_ticks.empty() ? 0.05 : 0.0;
  if (panel.robust) {
    axes.y = RangeOf(axes.scale, margin, panel.y_noise);
  } else if (y.any()) {
    axes.y = RangeFor(y.least, y.most, margin, panel.y_noise, axes.log_y);
  }
  if (panel.equal_scales) {
    const double least = kLeastProportion * std::max(axes.x.upper - axes.x.lower, axes.y.upper - axes.y.lower);
    Widen(least, axes.x);
    Widen(least, axes.y);
  }
  return axes;
}

// Without ticks gnuplot would choose some.
std::string SetTicks(const std::string& axis, const std::vector<Tick>& ticks) {
  if (ticks.empty()) return absl::StrCat("unset ", axis, "tics\n");
  const auto append = [](std::string* text, const Tick& tick) {
    absl::StrAppend(text, Quoted(tick.label), " ", ShortestDecimal(tick.at));
  };
  return absl::StrCat("set ", axis, "tics (", absl::StrJoin(ticks, ", ", append), ")\n");
}

std::string RangeText(const AxisRange& range) {
  return absl::StrCat("[", ShortestDecimal(range.lower), ":", ShortestDecimal(range.upper), "]");
}

// Returns the ticks of a scale with values on it, one above the other along `length` pixels.
std::vector<Tick> TicksOf(const Scale& scale, const AxisRange& range, double length, const Layout& layout) {
  if (!scale.any) return {};
  const double character = layout.character();
  return WithMarkedEnds(TicksFor(range, length, character, true, scale.log), scale, range, 2.5 * character / length);
}

void AppendLegend(const Legend& legend, std::string& script) {
  if (legend.place == Legend::Place::kNone) {
    absl::StrAppend(&script, "unset key\n");
    return;
  }
  absl::StrAppend(&script, "set key outside ",
                  legend.place == Legend::Place::kBeside ? "right center vertical" : "top center horizontal",
                  " reverse Left samplen 2\n");
}

// A panel with all that is to be known before it is drawn.
struct Drawing {
  const Panel& panel;
  std::vector<MapCell> cells;
  Axes axes;
  Legend legend;
  std::string title;

  double top_lines() const {
    const double lines = LinesOf(title) + 1.1 * legend.lines;
    return lines + (lines > 0.0 ? 1.9 : 1.3);
  }
};

Drawing DrawingOf(const Panel& panel, const Layout& layout) {
  std::vector<MapCell> cells = CellsOf(panel.map, panel.log_x, panel.log_y);
  Axes axes = panel.map.empty() ? AxesOf(panel) : AxesOfMap(panel, cells);
  std::vector<std::string> lines;
  const auto add = [&](const std::string& line) {
    if (!line.empty()) lines.push_back(WrappedAt(line, layout.across()));
  };
  add(panel.title);
  add(OutsideText(axes.scale));
  if (axes.left_out > 0) {
    add(absl::StrCat(Counted(axes.left_out, "point"), " at or below 0 not shown"));
  }
  return {panel, std::move(cells), axes, LegendOf(panel, layout), absl::StrJoin(lines, "\n")};
}

// The scale of the colours stands on the right of the frame: gnuplot leaves it no room for labels of its ticks.
void AppendScaleOfColours(size_t number, const Drawing& drawing, const Layout& layout, std::string& script) {
  const std::vector<Tick> ticks = TicksOf(drawing.axes.scale, drawing.axes.z, layout.frame_height(), layout);
  const std::string label = WrappedAt(drawing.panel.map_label, layout.upwards());
  const double letters = (static_cast<double>(Widest(ticks)) + 5.0) * layout.character();
  const double beside = letters + 1.5 * layout.font * LinesOf(label);
  // gnuplot draws the colours from 0.025 to 0.075 of the frame's width beside it.
  const double room = beside + 0.075 / 1.075 * layout.frame_width(beside);
  const auto column = static_cast<int>(number) % layout.columns;
  AppendColours(drawing.axes.scale, drawing.axes.z, SetTicks("cb", ticks), Quoted(label), script);
  absl::StrAppend(&script, "set rmargin at screen ", (column + 1.0) / layout.columns - room / layout.width, "\n");
}

void AppendAxes(size_t number, const Drawing& drawing, const Layout& layout, std::string& script) {
  const Panel& panel = drawing.panel;
  const Axes& axes = drawing.axes;
  double width = layout.frame_width(panel.map.empty() ? drawing.legend.width : 14.0 * layout.character());
  double height = layout.frame_height();
  if (panel.equal_scales) {
    const double x = axes.x.upper - axes.x.lower;
    const double y = axes.y.upper - axes.y.lower;
    const double scale = std::min(width / x, height / y);
    width = scale * x;
    height = scale * y;
  }
  const std::vector<Tick> x_ticks =
      TicksFor(axes.x, width, layout.character(), false, axes.log_x, panel.whole_x ? 1.0 : 0.0);
  const std::vector<Tick> y_ticks = !panel.y_ticks.empty() ? panel.y_ticks
                                    : panel.robust         ? TicksOf(axes.scale, axes.y, height, layout)
                                                   : TicksFor(axes.y, height, layout.character(), true, axes.log_y);
  // Ranges come first: a logarithmic axis refuses those of the panel before.
  absl::StrAppend(&script, "unset logscale\nset xrange ", RangeText(axes.x), "\nset yrange ", RangeText(axes.y), "\n");
  if (axes.log_x) absl::StrAppend(&script, "set logscale x\n");
  if (axes.log_y) absl::StrAppend(&script, "set logscale y\n");
  absl::StrAppend(&script, SetTicks("x", x_ticks), SetTicks("y", y_ticks),
                  panel.equal_scales ? "set size ratio -1\n" : "set size noratio\n");
  if (!panel.map.empty()) AppendScaleOfColours(number, drawing, layout, script);
}

void AppendMarks(const Panel& panel, std::string& script) {
  absl::StrAppend(&script, "unset arrow\n");
  constexpr char kStyle[] = " nohead dashtype 2 linecolor rgb 'gray40'\n";
  for (const double mark : panel.x_marks) {
    const std::string x = ShortestDecimal(mark);
    absl::StrAppend(&script, "set arrow from ", x, ", graph 0 to ", x, ", graph 1", kStyle);
  }
  for (const double mark : panel.y_marks) {
    const std::string y = ShortestDecimal(mark);
    absl::StrAppend(&script, "set arrow from graph 0, first ", y, " to graph 1, first ", y, kStyle);
  }
}

void AppendPanel(size_t number, const Drawing& drawing, const Layout& layout, std::string& script) {
  const Panel& panel = drawing.panel;
  const std::string prefix = absl::StrCat("p", number);
  std::vector<std::string> parts = AppendCells(prefix + "map", drawing.cells, drawing.axes.z, script);
  for (std::string& part : AppendCurves(prefix, panel, drawing.axes, script)) parts.push_back(std::move(part));
  // Every cell of a logarithmic map may be at or below 0.
  if (parts.empty()) parts.emplace_back("NaN with dots notitle");
  absl::StrAppend(&script, "set title ", Quoted(drawing.title), "\nset xlabel ",
                  Quoted(WrappedAt(panel.x_label, layout.across())), "\nset ylabel ",
                  Quoted(WrappedAt(panel.y_label, layout.upwards())), "\nset tmargin ", layout.top_lines, "\n");
  AppendLegend(drawing.legend, script);
  AppendMarks(panel, script);
  if (panel.settings.empty()) {
    AppendAxes(number, drawing, layout, script);
  } else {
    absl::StrAppend(&script, panel.settings);
  }
  absl::StrAppend(&script, "plot ", absl::StrJoin(parts, ", "), "\n");
}

// Returns the commands for gnuplot; `terminal` is "svg", "png" or "pdf".
std::string PlotScript(const Plot& plot, const std::string& terminal) {
  Layout layout = LayoutOf(plot);
  std::vector<Drawing> drawings;
  for (const Panel& panel : plot.panels) {
    drawings.push_back(DrawingOf(panel, layout));
    layout.top_lines = std::max(layout.top_lines, drawings.back().top_lines());
  }
  std::string title = WrappedAt(plot.title, layout.title_characters());
  // Room for the legends between the title and the panels.
  const bool has_legends = std::any_of(drawings.begin(), drawings.end(), [](const Drawing& drawing) {
    return drawing.legend.place == Legend::Place::kAbove;
  });
  if (has_legends) title += '\n';
  std::string script =
      absl::StrCat("set encoding utf8\nset terminal ", Terminal(terminal, layout), "\nset termoption noenhanced\n",
                   kGrid, "set multiplot layout ", layout.rows, ",", layout.columns, " title ", Quoted(title), "\n");
  for (size_t i = 0; i < drawings.size(); ++i) AppendPanel(i, drawings[i], layout, script);
  absl::StrAppend(&script, "unset multiplot\n");
  return script;
}

// The length of an axis, which may have both signs, and a margin must not leave the range of doubles; nor may the lower
// end of a logarithmic axis.
bool Fits(double number, bool log) {
  return !std::isfinite(number) || (std::fabs(number) <= 1e300 && !(log && number > 0.0 && number < kLeastOnAxis));
}

bool CanBeDrawn(const Plot& plot) {
  for (const Panel& panel : plot.panels) {
    for (const Curve& curve : panel.curves) {
      for (const auto& [x, y] : curve.points) {
        if (!Fits(x, panel.log_x) || !Fits(y, panel.log_y)) return false;
      }
    }
    for (const MapPoint& point : panel.map) {
      if (!Fits(point.x, panel.log_x) || !Fits(point.y, panel.log_y) || !Fits(point.value, false)) return false;
    }
  }
  return true;
}

}  // namespace

absl::StatusOr<std::string> DrawAs(const Plot& plot, const std::string& format) {
  if (!CanBeDrawn(plot)) {
    return absl::InvalidArgumentError(
        "the picture has numbers beyond 1e300, or below 1e-300 on a logarithmic axis, which no axis can show");
  }
  absl::StatusOr<std::string> picture = RunGnuplot(PlotScript(plot, format));
  if (!picture.ok()) return picture.status();
  const char* const end = format == "svg" ? "</svg>" : format == "png" ? "IEND\xAE\x42\x60\x82" : "%%EOF";
  if (absl::EndsWith(absl::StripTrailingAsciiWhitespace(*picture), end)) return picture;
  return absl::InternalError(absl::StrCat("gnuplot broke off after ", picture->size(), " bytes of the picture"));
}

absl::Status Draw(const Plot& plot, const std::string& path) {
  const absl::StatusOr<std::string> picture = DrawAs(plot, IsStandardOutput(path) ? "svg" : EndingOf(path));
  return picture.ok() ? WriteFile(path, *picture) : picture.status();
}

}  // namespace ricochet::cli
