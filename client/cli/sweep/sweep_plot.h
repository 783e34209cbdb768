// SweepPlot: draws a sweep. Curves go over its last axis, one for each column and each combination of the other axes,
// in one panel for each unit. A map has the last of two axes to the right, the first upwards, and one panel for each
// column.

#ifndef RICOCHET_CLIENT_CLI_SWEEP_SWEEP_PLOT_H_
#define RICOCHET_CLIENT_CLI_SWEEP_SWEEP_PLOT_H_

#include "absl/status/statusor.h"
#include "client/cli/plot/picture_input.h"
#include "client/cli/plot/plot.h"
#include "client/cli/sweep/sweep_table.h"
#include "client/cli/text/axis_cursor.h"
#include "ricochet/sweep.h"

namespace ricochet::cli {

// Returns the plot of all points. The picture depends on nothing but the table, so that a file gives the picture of the
// sweep that wrote it. Errors: FAILED_PRECONDITION for too many points or curves, without an axis, or if the kind is
// kMap and there is no grid of two axes.
absl::StatusOr<Plot> PlotOf(const SweepTable& table, PlotKind kind);

// Collects the points of a sweep while it runs.
class SweepPlot {
 public:
  // `request` is the sweep that Wanted returned.
  SweepPlot(const SweepRequest& request, PlotKind kind);
  SweepPlot(const SweepPlot&) = delete;
  SweepPlot& operator=(const SweepPlot&) = delete;

  // Returns the sweep that a picture needs: `request` with the regimes of its points.
  static SweepRequest Wanted(SweepRequest request);

  // Adds the points of a chunk. After an error it ignores all further chunks, and Make returns the error.
  void Add(const SweepChunk& chunk);
  bool fits() const { return status_.ok(); }
  // Returns the plot of all points added. Errors: those of PlotOf.
  absl::StatusOr<Plot> Make() const;

 private:
  Grid grid_;
  AxisCursor cursor_;
  PlotKind kind_;
  SweepTable table_;
  absl::Status status_;
};

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_SWEEP_SWEEP_PLOT_H_
