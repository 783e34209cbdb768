#include "client/cli/text/table.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/cli/text/wrap.h"

namespace ricochet::cli {
namespace {

bool terminal_counts = true;

// Returns the columns of the terminal: COLUMNS if it is set, else those of standard output; `unknown` if it is none.
size_t TerminalWidth(size_t unknown) {
  if (!terminal_counts) return unknown;
  const char* columns = std::getenv("COLUMNS");
  int width = 0;
  if (columns != nullptr && absl::SimpleAtoi(columns, &width) && width > 0) return static_cast<size_t>(width);
  winsize size = {};
  const bool is_terminal = ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return is_terminal ? size.ws_col : unknown;
}

}  // namespace

void ForgetTerminalWidth() { terminal_counts = false; }

std::string Wrapped(const std::string& text, size_t indent) {
  return absl::StrCat(std::string(indent, ' '), WrapWords(text, TerminalWidth(/*unknown=*/80), indent, indent), "\n");
}

std::vector<size_t> Table::Widths() const {
  std::vector<size_t> widths;
  for (const auto& row : rows_) {
    if (widths.size() < row.size()) widths.resize(row.size());
    for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], Characters(row[i]));
  }
  return widths;
}

std::string Table::RenderColumns(const std::vector<size_t>& widths, size_t from, size_t to, size_t indent,
                                 size_t gap) const {
  std::string text;
  for (const auto& row : rows_) {
    std::string line(indent, ' ');
    if (!row.empty()) absl::StrAppend(&line, row[0], std::string(widths[0] - Characters(row[0]), ' '));
    for (size_t i = from; i < std::min(to, row.size()); ++i) {
      const std::string padding(widths[i] - Characters(row[i]), ' ');
      const bool is_left = align_ == Align::kLeft;
      absl::StrAppend(&line, std::string(gap, ' '), is_left ? row[i] : padding, is_left ? padding : row[i]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    absl::StrAppend(&text, line, "\n");
  }
  return text;
}

std::string Table::Render(size_t indent, size_t gap) const {
  const std::vector<size_t> widths = Widths();
  if (widths.empty()) return "";
  const size_t most = TerminalWidth(/*unknown=*/std::numeric_limits<size_t>::max());
  std::string text;
  size_t from = 1;
  do {
    size_t to = from;
    size_t width = indent + widths[0];
    // A column that is too wide by itself stands alone.
    while (to < widths.size() && (to == from || width + gap + widths[to] <= most)) width += gap + widths[to++];
    absl::StrAppend(&text, text.empty() ? "" : "\n", RenderColumns(widths, from, to, indent, gap));
    from = to;
  } while (from < widths.size());
  return text;
}

std::string Rounded(double value) { return absl::StrFormat("%.6g", value + 0.0); }

}  // namespace ricochet::cli
