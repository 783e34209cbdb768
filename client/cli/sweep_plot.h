// SweepPlot: draws a sweep as curves over its last axis, one for each column and each combination of the other axes.

#ifndef RICOCHET_CLIENT_CLI_SWEEP_PLOT_H_
#define RICOCHET_CLIENT_CLI_SWEEP_PLOT_H_

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/plot.h"
#include "ricochet/sweep.h"

namespace ricochet::cli {

// It keeps all points in memory, so it refuses more than a picture can show.
class SweepPlot {
 public:
  static constexpr int64_t kMostPoints = 1'000'000;
  static constexpr size_t kMostCurves = 48;

  explicit SweepPlot(SweepRequest request) : request_(std::move(request)) {}

  // Adds the points of a chunk. Errors: FAILED_PRECONDITION for too many points or curves, or without an axis.
  absl::Status Add(const SweepChunk& chunk);
  // Returns the plot of all points added.
  Plot Make() const;

 private:
  struct Line {
    std::vector<int64_t> outer;  // The positions on all axes except the last; empty under zip.
    size_t column;
    bool operator<(const Line& other) const { return std::pair(outer, column) < std::pair(other.outer, other.column); }
  };
  std::string Title(const Line& line) const;

  SweepRequest request_;
  std::map<Line, std::vector<std::pair<double, double>>> lines_;
};

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_SWEEP_PLOT_H_
