// Table: rows of text in aligned columns. The first column is aligned to the left, the others to the right.

#ifndef RICOCHET_CLIENT_CLI_TEXT_TABLE_H_
#define RICOCHET_CLIENT_CLI_TEXT_TABLE_H_

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace ricochet::cli {

class Table {
 public:
  // Align says how the columns after the first are aligned.
  enum class Align { kLeft, kRight };
  explicit Table(Align align = Align::kRight) : align_(align) {}

  // A row may have fewer cells than others.
  void Add(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }

  // Returns each row on its own line after `indent` spaces, with `gap` spaces between columns. Columns for which the
  // terminal is too narrow follow below, after the first column again; files and pipes are never too narrow.
  std::string Render(size_t indent, size_t gap = 3) const;

 private:
  std::vector<size_t> Widths() const;
  // Renders the first column and the columns [from, to).
  std::string RenderColumns(const std::vector<size_t>& widths, size_t from, size_t to, size_t indent, size_t gap) const;

  Align align_;
  std::vector<std::vector<std::string>> rows_;
};

// Stops the use of the terminal's width: text now goes to a file, whose lines must not depend on the terminal.
void ForgetTerminalWidth();

// Returns the text in lines that fit into the terminal, or into 80 columns, each after `indent` spaces.
std::string Wrapped(const std::string& text, size_t indent);

// Returns `value` with six significant digits; -0 becomes 0.
std::string Rounded(double value);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_TEXT_TABLE_H_
