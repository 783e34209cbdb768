// Layout: where the panels of a plot stand, and the room for letters, titles and legends around them.

#ifndef RICOCHET_CLIENT_CLI_PLOT_PLOT_LAYOUT_H_
#define RICOCHET_CLIENT_CLI_PLOT_PLOT_LAYOUT_H_

#include <string>

#include "client/cli/plot/plot.h"

namespace ricochet::cli {

// The size of the picture in pixels, and of the cell that each panel has in it.
struct Layout {
  int rows = 1;
  int columns = 1;
  int width = 0;
  int height = 0;
  double font = 0.0;       // Height of the letters.
  int title_lines = 0;     // The title of the picture has so many, above all rows.
  double top_lines = 1.0;  // Every panel has so many above its frame, so that all frames of a row stand at one height.

  double cell_width() const { return static_cast<double>(width) / columns; }
  double cell_height() const { return static_cast<double>(height) / rows; }
  double character() const { return kLetterWidth * font; }  // The mean width of a letter.
  // Returns the characters in a line of the title, whose letters are a tenth larger.
  double title_characters() const { return width / character() / 1.1 - 2.0; }
  // Return the characters in a line across a panel, and in one upwards beside it.
  double across() const { return cell_width() / character() - 4.0; }
  double upwards() const { return cell_height() / character() - 8.0; }
  // Returns the width that the labels of the axes, the titles and what stands `beside` the frame leave of a cell.
  double frame_width(double beside) const { return cell_width() - 9.0 * character() - 2.0 * font - beside; }
  double frame_height() const;
};

// Returns the layout for the panels, all but its top_lines.
Layout LayoutOf(const Plot& plot);

// Breaks the text at blanks into lines of at most `most` characters, as far as its words allow.
std::string WrappedAt(const std::string& text, double most);

// Counts the lines of a text; an empty one has none.
int LinesOf(const std::string& text);

// A legend: beside the panel, above it, or none.
struct Legend {
  enum class Place { kNone, kBeside, kAbove } place = Place::kNone;
  double width = 0.0;  // Pixels that it takes from the panel, beside it.
  int lines = 0;       // Lines that it takes from the panel, above it.
};

Legend LegendOf(const Panel& panel, const Layout& layout);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_PLOT_PLOT_LAYOUT_H_
