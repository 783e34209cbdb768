// Writers of sweeps: each turns chunks, given in order, into text. Memory does not depend on the number of points.

#ifndef RICOCHET_CLIENT_CLI_SWEEP_SWEEP_WRITER_H_
#define RICOCHET_CLIENT_CLI_SWEEP_SWEEP_WRITER_H_

#include <cstdint>
#include <functional>
#include <string>

#include "absl/status/statusor.h"
#include "client/cli/io/output_format.h"
#include "ricochet/sweep.h"

namespace ricochet::cli {

// Returns the text of one chunk, which may be empty. The text of all points does not depend on how chunks cut them.
using SweepWriter = std::function<absl::StatusOr<std::string>(const SweepChunk&)>;

// A point has its index, the values of the axes, the columns and, with the regimes, its regime and its status: OK,
// INADMISSIBLE, or INVALID or NOT_REPRESENTABLE and the reason. kText gives a table of the first `table_points` points
// and the summary. kJson gives one document: engine, axes
// and columns with their units, a list for each point, and the summary. kJsonLines gives an object on a line for each
// point. kCsv gives a header before the first point of the range, and a line for each point. With `summary_only` there
// is only the summary, as text, as the JSON of ricochet.v1.SweepSummary, or as CSV. kNpy is that of MakeNpyWriter.
// NetCDF is no text and has no writer.
SweepWriter MakeSweepWriter(const SweepRequest& request, Format format, bool summary_only = false,
                            int64_t table_points = 0);

// The array of records in NumPy's format NPY, for numpy.load: the header before the first point of the range, and then
// one record for each point. The fields of a record are index (int64), the axes and the columns by their paths
// (float64), and regime and status (uint8, the numbers of ricochet.v1.Regime and RowStatus) if they were asked for.
SweepWriter MakeNpyWriter(const SweepRequest& request);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_SWEEP_SWEEP_WRITER_H_
