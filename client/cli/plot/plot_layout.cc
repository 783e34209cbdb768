#include "client/cli/plot/plot_layout.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "client/cli/plot/plot_map.h"
#include "client/cli/text/wrap.h"

namespace ricochet::cli {
namespace {

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

// The names in the legend of a panel.
std::vector<std::string> NamesOf(const Panel& panel) {
  std::vector<std::string> names = LegendOfCells(panel.map);
  if (!panel.x_missing.empty()) names.emplace_back(kNoValue);
  for (const Curve& curve : panel.curves) {
    if (!curve.title.empty()) names.push_back(curve.title);
  }
  return names;
}

}  // namespace

double LetterHeight(double cell_width, double cell_height) {
  return std::clamp(std::min(cell_width / 40.0, cell_height / 30.0), 9.0, 15.0);
}

double Layout::frame_height() const {
  // Below the frame are the labels of its axis, of up to two lines.
  const double lines = 4.5 + 1.3 * top_lines + 1.5 * title_lines / rows;
  return std::max(font, cell_height() - lines * font);
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
  layout.title_lines = std::max(1, LinesOf(WrappedAt(plot.title, layout.title_characters())));
  return layout;
}

std::string WrappedAt(const std::string& text, double most) {
  return WrapWords(text, static_cast<size_t>(std::max(most, 0.0)), 0, 0, Units::kKept);
}

int LinesOf(const std::string& text) {
  return text.empty() ? 0 : 1 + static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

Legend LegendOf(const Panel& panel, const Layout& layout) {
  const std::vector<std::string> names = NamesOf(panel);
  const bool is_map = !panel.map.empty();
  // A curve that is alone needs no name; cells and marks on a map do.
  if (names.empty() || (names.size() == 1 && panel.curves.size() == 1 && !is_map)) return {};
  size_t longest = 0;
  for (const std::string& name : names) longest = std::max(longest, Characters(name));
  const auto count = static_cast<int>(names.size());
  const double width = (static_cast<double>(longest) + 7.0) * layout.character();
  const double height = 1.3 * layout.font * count;
  const bool fits = width <= 0.34 * layout.cell_width() && height <= layout.cell_height() - 6.0 * layout.font;
  // A map has the scale of its colours beside it, where a legend would need the room.
  if (layout.columns == 1 && fits && !is_map) return {Legend::Place::kBeside, width, 0};
  // gnuplot puts as many names into a line as the frame is wide.
  const double room = layout.frame_width(is_map ? 10.0 * layout.character() : -2.0 * layout.character());
  const int in_a_line =
      std::max(1, static_cast<int>(room / ((static_cast<double>(longest) + 4.5) * layout.character())));
  return {Legend::Place::kAbove, 0.0, (count + in_a_line - 1) / in_a_line};
}

}  // namespace ricochet::cli
