#include "client/cli/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

#include "absl/status/status.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "client/cli/gnuplot.h"
#include "client/cli/output.h"
#include "core/numerics/decimal.h"

namespace ricochet::cli {
namespace {

// Okabe and Ito's colours, which the colour-blind can tell apart, without the yellow.
constexpr std::array kColours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000"};
// After all colours the next dashes begin: 49 looks in all.
constexpr std::array kDashes = {"1", "'-'", "'.'", "'-.'", "'_ '", "'-..'", "'_.'"};

constexpr char kGrid[] = "set grid linecolor rgb '#d8d8d8' linewidth 1 linetype 1\n";

// The size of the picture, and of the cell that each panel has in it.
struct Layout {
  int rows = 1;
  int columns = 1;
  int width = 0;
  int height = 0;
  double font = 0.0;    // Height of the letters in pixels.
  int title_lines = 0;  // Of the title of the picture, above all rows.

  double cell_width() const { return static_cast<double>(width) / columns; }
  double cell_height() const { return static_cast<double>(height) / rows; }
  double character() const { return kLetterWidth * font; }  // The mean width of a letter.
  // The length of a line of the title; its letters are a tenth larger.
  double title_characters() const { return width / character() / 1.1 - 2.0; }
};

constexpr int kCellWidth = 640;
constexpr int kCellHeight = 520;
constexpr int kMostColumns = 3;

// Returns the number of columns that makes the cells most like a panel of its own: 4 wide and 3 high.
int ColumnsFor(int panels, double width, double height) {
  const auto unlikeness = [&](int columns) {
    const int rows = (panels + columns - 1) / columns;
    return std::abs(std::log(width / columns / (height / rows) / (4.0 / 3.0)));
  };
  int best = 1;
  for (int columns = 2; columns <= panels; ++columns) {
    if (unlikeness(columns) < unlikeness(best)) best = columns;
  }
  return best;
}

// Breaks the text at blanks into lines of at most `most` characters, as far as its words allow.
std::string Wrapped(const std::string& text, double most) {
  std::string wrapped;
  size_t length = 0;
  for (const auto word : absl::StrSplit(text, ' ')) {
    if (length > 0 && static_cast<double>(length + 1 + word.size()) > most) {
      wrapped += '\n';
      length = 0;
    } else if (length > 0) {
      wrapped += ' ';
      ++length;
    }
    absl::StrAppend(&wrapped, word);
    length += word.size();
  }
  return wrapped;
}

Layout LayoutOf(const Plot& plot) {
  const auto panels = static_cast<int>(plot.panels.size());
  Layout layout;
  if (plot.width > 0 && plot.height > 0) {
    layout.width = plot.width;
    layout.height = plot.height;
    layout.columns = ColumnsFor(panels, layout.width, layout.height);
  } else {
    layout.columns = panels == 4 ? 2 : std::min(panels, kMostColumns);
    const int rows = (panels + layout.columns - 1) / layout.columns;
    layout.width = panels == 1 ? 960 : kCellWidth * layout.columns;
    layout.height = rows == 1 ? 620 : kCellHeight * rows;
  }
  layout.rows = (panels + layout.columns - 1) / layout.columns;
  layout.font = LetterHeight(layout.cell_width(), layout.cell_height());
  const std::string title = Wrapped(plot.title, layout.title_characters());
  layout.title_lines = 1 + static_cast<int>(std::count(title.begin(), title.end(), '\n'));
  return layout;
}

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

std::string LineStyle(int look) {
  const size_t dash = static_cast<size_t>(look) / kColours.size() % kDashes.size();
  return absl::StrCat("with lines linewidth 2 dashtype ", kDashes[dash], " linecolor rgb '", ColourOf(look), "'");
}

std::string MarkStyle(int look) {
  return absl::StrCat("with points pointtype 7 pointsize 0.6 linecolor rgb '", ColourOf(look), "'");
}

// Which points of a panel its axes can show.
class Shown {
 public:
  explicit Shown(const Panel& panel) : panel_(panel) {}
  bool operator()(const std::pair<double, double>& point) const {
    return std::isfinite(point.first) && std::isfinite(point.second) && !(panel_.log_x && point.first <= 0.0) &&
           !(panel_.log_y && point.second <= 0.0);
  }

 private:
  const Panel& panel_;
};

using Points = std::vector<std::pair<double, double>>;

// Returns the points of a curve without a shown point beside them: a line does not show them.
Points Isolated(const Points& points, const Shown& is_shown) {
  Points isolated;
  for (size_t i = 0; i < points.size(); ++i) {
    const bool after = i > 0 && is_shown(points[i - 1]);
    const bool before = i + 1 < points.size() && is_shown(points[i + 1]);
    if (is_shown(points[i]) && !after && !before) isolated.push_back(points[i]);
  }
  return isolated;
}

// Appends a block of data; an empty line ends a line of the picture.
void AppendData(const std::string& name, const Points& points, const Shown& is_shown, std::string& script) {
  absl::StrAppend(&script, "$", name, " << EOD\n");
  bool any = false;
  for (const auto& point : points) {
    any = any || is_shown(point);
    absl::StrAppend(&script, is_shown(point)
                                 ? absl::StrCat(ShortestDecimal(point.first), " ", ShortestDecimal(point.second), "\n")
                                 : "\n");
  }
  // gnuplot refuses a block without a point.
  if (!any) absl::StrAppend(&script, "nan nan\n");
  absl::StrAppend(&script, "EOD\n");
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

struct Axes {
  AxisRange x;
  AxisRange y;
  AxisRange z;           // That of the colours of a map.
  int64_t left_out = 0;  // Points that a logarithmic axis cannot show.
};

// Cells fill the frame.
Axes AxesOfMap(const Panel& panel, const std::vector<MapCell>& cells) {
  Ends x;
  Ends y;
  Ends z;
  for (const MapCell& cell : cells) {
    x.Add(cell.left);
    x.Add(cell.right);
    y.Add(cell.bottom);
    y.Add(cell.top);
    if (std::isfinite(cell.value)) z.Add(cell.value);
  }
  const AxisRange none{1.0, 10.0};
  return {.x = x.any() ? AxisRange{x.least, x.most} : none,
          .y = y.any() ? AxisRange{y.least, y.most} : none,
          .z = z.any() ? RangeFor(z.least, z.most, 0.0, 0.0, false) : none,
          .left_out = static_cast<int64_t>(panel.map.size() - cells.size())};
}

Axes AxesOf(const Panel& panel) {
  const Shown is_shown(panel);
  Ends x;
  Ends y;
  Axes axes;
  for (const Curve& curve : panel.curves) {
    for (const auto& point : curve.points) {
      if (is_shown(point)) {
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
    if (!panel.log_y || mark > 0.0) y.Add(mark);
  }
  for (const Tick& tick : panel.y_ticks) {
    y.Add(tick.at - 0.6);
    y.Add(tick.at + 0.6);
  }
  // Lines may begin and end at the frame; marks need room.
  const bool has_marks =
      std::any_of(panel.curves.begin(), panel.curves.end(), [](const Curve& curve) { return !curve.style.empty(); });
  axes.x = x.any() ? RangeFor(x.least, x.most, has_marks ? 0.04 : 0.0, 0.0, panel.log_x) : AxisRange{1.0, 10.0};
  axes.y = y.any() ? RangeFor(y.least, y.most, panel.y_ticks.empty() ? 0.05 : 0.0, panel.y_noise, panel.log_y)
                   : AxisRange{1.0, 10.0};
  return axes;
}

std::string TickList(const std::vector<Tick>& ticks) {
  const auto append = [](std::string* text, const Tick& tick) {
    absl::StrAppend(text, Quoted(tick.label), " ", ShortestDecimal(tick.at));
  };
  return absl::StrCat("(", absl::StrJoin(ticks, ", ", append), ")");
}

// A legend: beside the panel, above it, or none.
struct Legend {
  enum class Place { kNone, kBeside, kAbove } place = Place::kNone;
  double width = 0.0;  // Pixels that it takes from the panel, beside it.
  int lines = 0;       // Lines that it takes from the panel, above it.
};

Legend LegendOf(const Panel& panel, const Layout& layout) {
  size_t longest = 0;
  int titles = panel.x_missing.empty() ? 0 : 1;
  for (const Curve& curve : panel.curves) {
    if (curve.title.empty()) continue;
    longest = std::max(longest, curve.title.size());
    ++titles;
  }
  const bool is_map = !panel.map.empty();
  // A curve that is alone needs no name; marks on a map do.
  if (titles == 0 || (titles == 1 && panel.curves.size() == 1 && !is_map)) return {};
  const double width = (static_cast<double>(longest) + 7.0) * layout.character();
  const double height = 1.3 * layout.font * titles;
  const bool fits = width <= 0.34 * layout.cell_width() && height <= layout.cell_height() - 6.0 * layout.font;
  // Beside a map is the scale of its colours.
  if (layout.columns == 1 && fits && !is_map) return {Legend::Place::kBeside, width, 0};
  const int in_a_line = std::max(1, static_cast<int>(0.9 * layout.cell_width() / width));
  return {Legend::Place::kAbove, 0.0, (titles + in_a_line - 1) / in_a_line};
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

void AppendAxes(const Panel& panel, const Axes& axes, const Layout& layout, std::string& script) {
  // What is left of a cell between the labels of the axes, the title and the legend or the scale of the colours.
  const Legend legend = LegendOf(panel, layout);
  const double beside = panel.map.empty() ? legend.width : 14.0 * layout.character();
  double width = layout.cell_width() - 9.0 * layout.character() - 2.0 * layout.font - beside;
  const double lines = 7.0 + 1.3 * legend.lines + 1.5 * layout.title_lines / layout.rows;
  double height = std::max(layout.font, layout.cell_height() - lines * layout.font);
  if (panel.equal_scales) {
    const double x = axes.x.upper - axes.x.lower;
    const double y = axes.y.upper - axes.y.lower;
    const double scale = std::min(width / x, height / y);
    width = scale * x;
    height = scale * y;
  }
  const std::vector<Tick> x_ticks =
      TicksFor(axes.x, width, layout.character(), false, panel.log_x, panel.whole_x ? 1.0 : 0.0);
  const std::vector<Tick> y_ticks =
      !panel.y_ticks.empty() ? panel.y_ticks : TicksFor(axes.y, height, layout.character(), true, panel.log_y);
  const auto range = [](const AxisRange& axis) {
    return absl::StrCat("[", ShortestDecimal(axis.lower), ":", ShortestDecimal(axis.upper), "]");
  };
  // Ranges come first: a logarithmic axis refuses those of the panel before.
  absl::StrAppend(&script, "unset logscale\nset xrange ", range(axes.x), "\nset yrange ", range(axes.y), "\n");
  if (panel.log_x) absl::StrAppend(&script, "set logscale x\n");
  if (panel.log_y) absl::StrAppend(&script, "set logscale y\n");
  absl::StrAppend(&script, "set xtics ", TickList(x_ticks), "\nset ytics ", TickList(y_ticks), "\n",
                  panel.equal_scales ? "set size ratio -1\n" : "set size noratio\n");
  if (panel.map.empty()) return;
  const double up = layout.cell_height() / layout.character() - 8.0;
  AppendColours(axes.z, TickList(TicksFor(axes.z, height, layout.character(), true, false)),
                Quoted(Wrapped(panel.map_label, up)), script);
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

void AppendPanel(size_t number, const Panel& panel, const Layout& layout, std::string& script) {
  const Shown is_shown(panel);
  const std::vector<MapCell> cells = CellsOf(panel.map, panel.log_x, panel.log_y);
  const Axes axes = panel.map.empty() ? AxesOf(panel) : AxesOfMap(panel, cells);
  std::vector<std::string> parts = AppendCells(absl::StrCat("p", number, "map"), cells, script);
  const auto add = [&](const std::string& name, const Points& points, const std::string& style,
                       const std::string& title) {
    AppendData(name, points, is_shown, script);
    parts.push_back(absl::StrCat("$", name, " using 1:2 ", style,
                                 title.empty() ? " notitle" : absl::StrCat(" title ", Quoted(title))));
  };
  for (size_t i = 0; i < panel.curves.size(); ++i) {
    const Curve& curve = panel.curves[i];
    const int look = curve.look >= 0 ? curve.look : static_cast<int>(i);
    const std::string name = absl::StrCat("p", number, "c", i);
    add(name, curve.points, curve.style.empty() ? LineStyle(look) : curve.style, curve.title);
    if (!curve.style.empty()) continue;
    const Points isolated = Isolated(curve.points, is_shown);
    if (!isolated.empty()) add(absl::StrCat(name, "points"), isolated, MarkStyle(look), "");
  }
  if (!panel.x_missing.empty()) {
    Points crosses;
    for (const double x : panel.x_missing) crosses.emplace_back(x, axes.y.lower);
    add(absl::StrCat("p", number, "missing"), crosses,
        "with points pointtype 2 pointsize 1.2 linewidth 2 linecolor rgb '#7F7F7F'", "no value (invalid)");
  }
  const double across = layout.cell_width() / layout.character() - 4.0;
  const double up = layout.cell_height() / layout.character() - 8.0;
  std::string title = panel.title;
  if (std::any_of(cells.begin(), cells.end(), [](const MapCell& cell) { return !std::isfinite(cell.value); })) {
    absl::StrAppend(&title, title.empty() ? "" : "\n", "grey: no value (invalid)");
  }
  if (axes.left_out > 0) {
    absl::StrAppend(&title, title.empty() ? "" : "\n", axes.left_out, axes.left_out == 1 ? " point" : " points",
                    " at or below 0 not shown");
  }
  absl::StrAppend(&script, "set title ", Quoted(Wrapped(title, across)), "\nset xlabel ",
                  Quoted(Wrapped(panel.x_label, across)), "\nset ylabel ", Quoted(Wrapped(panel.y_label, up)), "\n");
  AppendLegend(LegendOf(panel, layout), script);
  AppendMarks(panel, script);
  if (panel.settings.empty()) {
    AppendAxes(panel, axes, layout, script);
  } else {
    absl::StrAppend(&script, panel.settings);
  }
  // Every cell of a logarithmic map may be at or below 0.
  if (parts.empty()) add(absl::StrCat("p", number, "nothing"), {}, "with dots", "");
  absl::StrAppend(&script, "plot ", absl::StrJoin(parts, ", "), "\n");
}

}  // namespace

double LetterHeight(double cell_width, double cell_height) {
  return std::clamp(std::min(cell_width / 40.0, cell_height / 30.0), 9.0, 15.0);
}

absl::Status CheckPlotPath(const std::string& option, const std::string& path) {
  for (const char* ending : {".svg", ".png", ".pdf"}) {
    if (absl::EndsWith(path, ending)) return absl::OkStatus();
  }
  return absl::InvalidArgumentError(absl::StrCat(option, " ", path, ": must end in .svg, .png or .pdf"));
}

std::string PlotScript(const Plot& plot, const std::string& terminal, const std::string& path) {
  const Layout layout = LayoutOf(plot);
  std::string title = Wrapped(plot.title, layout.title_characters());
  // Room for the legends between the title and the panels.
  const bool has_legends = std::any_of(plot.panels.begin(), plot.panels.end(), [&](const Panel& panel) {
    return LegendOf(panel, layout).place == Legend::Place::kAbove;
  });
  if (has_legends) title += '\n';
  std::string script =
      absl::StrCat("set encoding utf8\nset terminal ", Terminal(terminal, layout),
                   "\nset termoption noenhanced\nset output ", Quoted(path), "\n", kGrid, "set multiplot layout ",
                   layout.rows, ",", layout.columns, " title ", Quoted(title), "\n");
  for (size_t i = 0; i < plot.panels.size(); ++i) AppendPanel(i, plot.panels[i], layout, script);
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
