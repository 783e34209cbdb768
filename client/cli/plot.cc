#include "client/cli/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>

#include "absl/status/status.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "client/cli/gnuplot.h"
#include "client/cli/output.h"
#include "client/cli/plot_layout.h"
#include "client/cli/plot_scale.h"
#include "core/numerics/decimal.h"

namespace ricochet::cli {
namespace {

// Okabe and Ito's colours, which the colour-blind can tell apart, without the yellow.
constexpr std::array kColours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000"};
// After all colours the next dashes begin: 49 looks in all.
constexpr std::array kDashes = {"1", "'-'", "'.'", "'-.'", "'_ '", "'-..'", "'_.'"};

constexpr char kGrid[] = "set grid linecolor rgb '#d8d8d8' linewidth 1 linetype 1\n";

constexpr double kLineWidth = 2.0;
// Of curves that lie on each other, each is so much wider than the next one, which is drawn upon it.
constexpr double kRibbon = 3.0;
constexpr int kMostRibbons = 4;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Returns a gnuplot string, in which only the quote is a special character.
std::string Quoted(const std::string& text) {
  std::vector<std::string> lines = absl::StrSplit(text, '\n');
  for (std::string& line : lines) line = absl::StrCat("'", absl::StrReplaceAll(line, {{"'", "''"}}), "'");
  return absl::StrJoin(lines, ".\"\\n\".");
}

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

std::string ColourOf(int look) { return kColours[static_cast<size_t>(look) % kColours.size()]; }

std::string LineStyle(int look, double width) {
  const size_t dash = static_cast<size_t>(look) / kColours.size() % kDashes.size();
  return absl::StrCat("with lines linewidth ", width, " dashtype ", kDashes[dash], " linecolor rgb '", ColourOf(look),
                      "'");
}

// A full circle, or a triangle up or down, by gnuplot's numbers.
enum class Mark { kCircle = 7, kUp = 9, kDown = 11 };

std::string MarkStyle(Mark mark, int look) {
  return absl::StrCat("with points pointtype ", static_cast<int>(mark), " pointsize ",
                      mark == Mark::kCircle ? 0.6 : 1.0, " linecolor rgb '", ColourOf(look), "'");
}

using Points = std::vector<std::pair<double, double>>;

struct Ends {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
  void Add(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
  bool any() const { return least <= most; }
};

constexpr AxisRange kNoRange{1.0, 10.0};

// What the axes of a panel show.
struct Axes {
  bool log_x = false;
  bool log_y = false;
  AxisRange x = kNoRange;
  AxisRange y = kNoRange;
  AxisRange z = kNoRange;  // That of the colours of a map.
  Scale scale;             // Of the colours of a map, else upwards; without values where the panel has a fixed one.
  int64_t left_out = 0;    // Points that a logarithmic axis cannot show.

  bool Shows(const std::pair<double, double>& point) const {
    return std::isfinite(point.first) && std::isfinite(point.second) && !(log_x && point.first <= 0.0) &&
           !(log_y && point.second <= 0.0);
  }
  // Returns where a shown value is on the axis upwards: 0 at its lower end, 1 at its upper end.
  double Height(double value) const {
    return log_y ? std::log(value / y.lower) / std::log(y.upper / y.lower) : (value - y.lower) / (y.upper - y.lower);
  }
};

// Returns the points of a curve without a shown point beside them: a line does not show them.
Points Isolated(const Points& points, const Axes& axes) {
  Points isolated;
  for (size_t i = 0; i < points.size(); ++i) {
    const bool after = i > 0 && axes.Shows(points[i - 1]);
    const bool before = i + 1 < points.size() && axes.Shows(points[i + 1]);
    if (axes.Shows(points[i]) && !after && !before) isolated.push_back(points[i]);
  }
  return isolated;
}

int64_t Shown(const Points& points, const Axes& axes) {
  return std::count_if(points.begin(), points.end(), [&](const auto& point) { return axes.Shows(point); });
}

// Appends a block of data; an empty line ends a line of the picture.
void AppendData(const std::string& name, const Points& points, const Axes& axes, std::string& script) {
  absl::StrAppend(&script, "$", name, " << EOD\n");
  bool any = false;
  for (const auto& point : points) {
    any = any || axes.Shows(point);
    absl::StrAppend(&script, axes.Shows(point)
                                 ? absl::StrCat(ShortestDecimal(point.first), " ", ShortestDecimal(point.second), "\n")
                                 : "\n");
  }
  // gnuplot refuses a block without a point.
  if (!any) absl::StrAppend(&script, "nan nan\n");
  absl::StrAppend(&script, "EOD\n");
}

// Cells fill the frame.
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

  double top_lines() const { return LinesOf(title) + 1.1 * legend.lines + 1.3; }
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
    add(absl::StrCat(axes.left_out, axes.left_out == 1 ? " point" : " points", " at or below 0 not shown"));
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

// How many later curves of the panel go through each point of a curve, to a pixel: they would hide it.
class Upon {
 public:
  Upon(const Panel& panel, const Axes& axes) : axes_(axes) {
    for (size_t i = 0; i < panel.curves.size(); ++i) {
      if (!panel.curves[i].style.empty()) continue;
      for (const auto& point : panel.curves[i].points) {
        if (axes.Shows(point)) curves_[PixelOf(point)].push_back(i);
      }
    }
  }

  // Returns the points of the curve that at least `least` later curves go through; NaN stands between parts of the line.
  Points On(const Points& points, size_t curve, int least) const {
    Points found;
    for (const auto& point : points) {
      bool is_hidden = false;
      if (axes_.Shows(point)) {
        const std::vector<size_t>& here = curves_.at(PixelOf(point));
        is_hidden = here.end() - std::upper_bound(here.begin(), here.end(), curve) >= least;
      }
      found.push_back(is_hidden ? point : std::pair(kNan, kNan));
    }
    return found;
  }

 private:
  using Pixel = std::pair<double, int64_t>;
  Pixel PixelOf(const std::pair<double, double>& point) const {
    const double height = std::clamp(axes_.Height(point.second), -1e9, 1e9);
    return {point.first, std::llround(1000.0 * height)};
  }

  const Axes& axes_;
  std::map<Pixel, std::vector<size_t>> curves_;
};

// Moves marks beyond the ends of the axis upwards to its ends.
Points WithinFrame(Points points, const Axes& axes) {
  for (auto& [x, y] : points) y = std::clamp(y, axes.y.lower, axes.y.upper);
  return points;
}

// Returns where the curve is beyond the upper or the lower end of the axis, at this end.
Points Beyond(const Points& points, const Axes& axes, Mark mark) {
  Points beyond;
  for (const auto& [x, y] : points) {
    if (mark == Mark::kUp ? y > axes.y.upper : y < axes.y.lower) {
      beyond.emplace_back(x, mark == Mark::kUp ? axes.y.upper : axes.y.lower);
    }
  }
  return beyond;
}

// Appends the data of a panel, and returns the parts of the command that plots them.
std::vector<std::string> AppendCurves(const std::string& prefix, const Drawing& drawing, std::string& script) {
  const Panel& panel = drawing.panel;
  const Axes& axes = drawing.axes;
  const Upon upon(panel, axes);
  std::vector<std::string> parts;
  std::vector<std::string> keys;
  const auto add = [&](const std::string& name, const Points& points, const std::string& style,
                       const std::string& title) {
    AppendData(name, points, axes, script);
    parts.push_back(absl::StrCat("$", name, " using 1:2 ", style,
                                 title.empty() ? " notitle" : absl::StrCat(" title ", Quoted(title))));
  };
  const auto add_marks = [&](const std::string& name, const Points& points, const std::string& style) {
    if (!points.empty()) add(name, points, style, "");
  };
  for (size_t i = 0; i < panel.curves.size(); ++i) {
    const Curve& curve = panel.curves[i];
    const int look = curve.look >= 0 ? curve.look : static_cast<int>(i);
    const std::string name = absl::StrCat(prefix, "c", i);
    if (!curve.key_style.empty()) {
      add(name, WithinFrame(curve.points, axes), curve.style, "");
      keys.push_back(absl::StrCat("keyentry ", curve.key_style, " title ", Quoted(curve.title)));
    } else if (!curve.style.empty()) {
      add(name, curve.points, curve.style, curve.title);
    }
    if (!curve.style.empty()) continue;
    // Where later curves lie on a tenth of this one or more, it is a ribbon below them, as wide as they are many.
    for (int later = kMostRibbons; later > 0; --later) {
      const Points hidden = upon.On(curve.points, i, later);
      if (10 * Shown(hidden, axes) < std::max<int64_t>(20, Shown(curve.points, axes))) continue;
      add(absl::StrCat(name, "ribbon", later), hidden, LineStyle(look, kLineWidth + kRibbon * later), "");
    }
    add(name, curve.points, LineStyle(look, kLineWidth), curve.title);
    add_marks(name + "points", Isolated(curve.points, axes), MarkStyle(Mark::kCircle, look));
    if (!panel.robust) continue;
    add_marks(name + "above", Beyond(curve.points, axes, Mark::kUp), MarkStyle(Mark::kUp, look));
    add_marks(name + "below", Beyond(curve.points, axes, Mark::kDown), MarkStyle(Mark::kDown, look));
  }
  if (!panel.x_missing.empty()) {
    Points crosses;
    for (const double x : panel.x_missing) crosses.emplace_back(x, axes.y.lower);
    add(prefix + "missing", crosses, "with points pointtype 2 pointsize 1.2 linewidth 2 linecolor rgb '#7F7F7F'",
        kNoValue);
  }
  parts.insert(parts.end(), keys.begin(), keys.end());
  // Every cell of a logarithmic map may be at or below 0.
  if (parts.empty() && drawing.cells.empty()) add(prefix + "nothing", {}, "with dots", "");
  return parts;
}

void AppendPanel(size_t number, const Drawing& drawing, const Layout& layout, std::string& script) {
  const Panel& panel = drawing.panel;
  const std::string prefix = absl::StrCat("p", number);
  std::vector<std::string> parts = AppendCells(prefix + "map", drawing.cells, drawing.axes.z, script);
  for (std::string& part : AppendCurves(prefix, drawing, script)) parts.push_back(std::move(part));
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

}  // namespace

absl::Status CheckPlotPath(const std::string& option, const std::string& path) {
  for (const char* ending : {".svg", ".png", ".pdf"}) {
    if (absl::EndsWith(path, ending)) return absl::OkStatus();
  }
  return absl::InvalidArgumentError(absl::StrCat(option, " ", path, ": must end in .svg, .png or .pdf"));
}

std::string PlotScript(const Plot& plot, const std::string& terminal, const std::string& path) {
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
      absl::StrCat("set encoding utf8\nset terminal ", Terminal(terminal, layout),
                   "\nset termoption noenhanced\nset output ", Quoted(path), "\n", kGrid, "set multiplot layout ",
                   layout.rows, ",", layout.columns, " title ", Quoted(title), "\n");
  for (size_t i = 0; i < drawings.size(); ++i) AppendPanel(i, drawings[i], layout, script);
  absl::StrAppend(&script, "unset multiplot\nunset output\n");
  return script;
}

absl::StatusOr<std::string> DrawSvg(const Plot& plot) {
  // The file is never committed, so that it is removed again.
  const absl::StatusOr<AtomicFile> file =
      AtomicFile::Create((std::filesystem::temp_directory_path() / "ricochet.svg").string());
  if (!file.ok()) return file.status();
  if (absl::Status status = RunGnuplot(PlotScript(plot, "svg", file->temporary_path())); !status.ok()) return status;
  std::ifstream stream(file->temporary_path(), std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(stream), {});
}

absl::Status Draw(const Plot& plot, const std::string& path) {
  absl::StatusOr<AtomicFile> file = AtomicFile::Create(path);
  if (!file.ok()) return file.status();
  const std::string terminal = path.substr(path.size() - 3);
  if (absl::Status status = RunGnuplot(PlotScript(plot, terminal, file->temporary_path())); !status.ok()) {
    return status;
  }
  return file->Commit();
}

}  // namespace ricochet::cli
