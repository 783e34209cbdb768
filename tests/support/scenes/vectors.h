// Reference vectors: tests/data/*.csv as rows of named cells.

#ifndef RICOCHET_TESTS_SUPPORT_SCENES_VECTORS_H_
#define RICOCHET_TESTS_SUPPORT_SCENES_VECTORS_H_

#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/paths.h"

namespace ricochet {

using VectorRow = std::map<std::string, std::string>;

inline std::vector<std::string> SplitCells(const std::string& line, char separator = ',') {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, separator);) cells.push_back(cell);
  return cells;
}

// Reads every row of tests/data/`name`, whose first line names the columns.
inline std::vector<VectorRow> ReadVectors(const std::string& name) {
  std::ifstream file(TestDataPath(name));
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> names = SplitCells(line);
  std::vector<VectorRow> rows;
  while (std::getline(file, line)) {
    const std::vector<std::string> cells = SplitCells(line);
    VectorRow& row = rows.emplace_back();
    for (size_t i = 0; i < names.size(); ++i) row[names[i]] = cells.at(i);
  }
  return rows;
}

inline double Number(const VectorRow& row, const char* column) { return std::strtod(row.at(column).c_str(), nullptr); }

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_SCENES_VECTORS_H_
