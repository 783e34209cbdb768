// Table: rows of text in aligned columns. The first column is aligned to the left, the others to the right.

#ifndef RICOCHET_CLIENT_CLI_TABLE_H_
#define RICOCHET_CLIENT_CLI_TABLE_H_

#include <string>
#include <vector>

namespace ricochet::cli {

class Table {
 public:
  // A row may have fewer cells than others.
  void Add(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }

  // Returns each row on its own line after `indent` spaces, with `gap` spaces between columns.
  std::string Render(size_t indent, size_t gap = 3) const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

// Returns `value` with six significant digits; -0 becomes 0.
std::string Rounded(double value);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_TABLE_H_
