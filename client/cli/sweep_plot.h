// SweepPlot: draws a sweep as curves over its last axis, one for each column and each combination of the other axes, in
// one panel for each unit.

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
  static constexpr size_t kMostCurves = 49;

  // `request` is the sweep that Wanted returned.
  explicit SweepPlot(SweepRequest request) : request_(std::move(request)) {}

  // Returns the sweep that a picture needs: `request` with the regimes of its points.
  static SweepRequest Wanted(SweepRequest request);

  // Adds the points of a chunk. After an error it ignores all further chunks, and Make returns the error.
  void Add(const SweepChunk& chunk);
  bool fits() const { return status_.ok(); }
  // Returns the plot of all points added. Errors: FAILED_PRECONDITION for too many points or curves, or without an
  // axis.
  absl::StatusOr<Plot> Make() const;

 private:
  struct Line {
    std::vector<int64_t> outer;  // The positions on all axes except the last; empty under zip.
    size_t column;
    bool operator<(const Line& other) const { return std::pair(outer, column) < std::pair(other.outer, other.column); }
  };
  struct Points {
    std::vector<std::pair<double, double>> all;  // A gap where the regime changes.
    std::vector<double> missing;                 // Where there is no value.
    Regime regime = Regime::kUnspecified;        // That of the last point.
  };

  absl::Status Check(const SweepChunk& chunk) const;
  std::string Title(const Line& line, size_t columns_in_panel) const;
  Panel PanelOf(const std::vector<size_t>& columns) const;

  SweepRequest request_;
  std::map<Line, Points> lines_;
  absl::Status status_;
};

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_SWEEP_PLOT_H_
