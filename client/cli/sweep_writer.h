// Writers of sweeps: each turns chunks, in order, into text. Memory does not depend on the number of points.

#ifndef RICOCHET_CLIENT_CLI_SWEEP_WRITER_H_
#define RICOCHET_CLIENT_CLI_SWEEP_WRITER_H_

#include <functional>
#include <string>

#include "absl/status/statusor.h"
#include "client/cli/common.h"
#include "ricochet/sweep.h"

namespace ricochet::cli {

// The text of one chunk.
using SweepWriter = std::function<absl::StatusOr<std::string>(const SweepChunk&)>;

// kText: a table of the first points and the summary. kJson: a response a line. kCsv: a point a line, at full
// precision: index, axes, columns, regime. With `summary_only` nothing but the summary, as text, as the JSON of
// ricochet.v1.SweepSummary, or as CSV.
SweepWriter MakeSweepWriter(const SweepRequest& request, Format format, bool summary_only);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_SWEEP_WRITER_H_
