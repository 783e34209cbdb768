// Reads the JSON of sweeps: one document, or an object on a line for each point.

#ifndef RICOCHET_CLIENT_CLI_SWEEP_SWEEP_JSON_H_
#define RICOCHET_CLIENT_CLI_SWEEP_SWEEP_JSON_H_

#include <istream>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/sweep/sweep_table.h"

namespace ricochet::cli {

// Reads from the beginning of the stream. `columns` are those to read, empty: all.
// Errors: INVALID_ARGUMENT if the text is not whole or not one of a sweep, or lacks a column; FAILED_PRECONDITION for
// more points than a picture can show.
absl::StatusOr<SweepTable> ReadSweepJson(std::istream& stream, const std::vector<std::string>& columns);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_SWEEP_SWEEP_JSON_H_
