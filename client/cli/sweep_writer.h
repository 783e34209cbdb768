// Writers of sweeps: each turns chunks, given in order, into text. Memory does not depend on the number of points.

#ifndef RICOCHET_CLIENT_CLI_SWEEP_WRITER_H_
#define RICOCHET_CLIENT_CLI_SWEEP_WRITER_H_

#include <functional>
#include <string>

#include "absl/status/statusor.h"
#include "client/cli/common.h"
#include "ricochet/sweep.h"

namespace ricochet::cli {

// Returns the text of one chunk, which may be empty.
using SweepWriter = std::function<absl::StatusOr<std::string>(const SweepChunk&)>;

// kText gives a table of the first points and the summary. kJson gives a ricochet.cli.SweepLine on each line. kCsv
// gives a header before the first point of the range, and a point on each line, at full precision: index, axes, columns,
// regime. With `summary_only` there is only the summary, as text, as the JSON of ricochet.v1.SweepSummary, or as CSV.
SweepWriter MakeSweepWriter(const SweepRequest& request, Format format, bool summary_only);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_SWEEP_WRITER_H_
