// SweepTable: the points of a sweep with their names, as a picture needs them, whether computed or read from a file.

#ifndef RICOCHET_CLIENT_CLI_SWEEP_SWEEP_TABLE_H_
#define RICOCHET_CLIENT_CLI_SWEEP_SWEEP_TABLE_H_

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "ricochet/outcome.h"
#include "ricochet/sweep.h"

namespace ricochet::cli {

struct SweepTable {
  // More points than this are no picture.
  static constexpr int64_t kMostPoints = 1'000'000;

  std::vector<double> index;                // Each point's place in its sweep; empty if the points are all of a sweep.
  std::vector<std::string> axes;            // Paths of the scene. The last axis runs fastest.
  std::vector<std::string> columns;         // Paths of the outcome.
  std::vector<std::vector<double>> at;      // For each axis, its value at each point.
  std::vector<std::vector<double>> values;  // For each column, its value at each point; NaN if there is none.
  std::vector<Regime> regimes;              // One for each point; empty if they are not known.
  std::vector<RowStatus> statuses;          // One for each point; empty if they are not known.
  // The units that a file states for names which the field table does not have.
  std::map<std::string, std::string> units;

  size_t points() const { return at.empty() ? 0 : at.front().size(); }
};

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_SWEEP_SWEEP_TABLE_H_
