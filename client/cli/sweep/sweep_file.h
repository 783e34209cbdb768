// Reads the files that `ricochet sweep` and `ricochet merge` write, for pictures.

#ifndef RICOCHET_CLIENT_CLI_SWEEP_SWEEP_FILE_H_
#define RICOCHET_CLIENT_CLI_SWEEP_SWEEP_FILE_H_

#include <istream>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/sweep/sweep_table.h"

namespace ricochet::cli {

// Reads CSV, JSON, NPY or NetCDF-4; the content says which, not the name. `columns` are those to read, empty: all.
// Every error names the file. Errors: INVALID_ARGUMENT if the file is not whole or not one of a sweep, or lacks a
// column; FAILED_PRECONDITION for more points than a picture can show; UNIMPLEMENTED for NetCDF in a build without it;
// those of the system.
absl::StatusOr<SweepTable> ReadSweepFile(const std::string& path, const std::vector<std::string>& columns);

// Reads the format that the name says, from its beginning. Errors do not name the file.
absl::StatusOr<SweepTable> ReadSweepJson(std::istream& stream, const std::vector<std::string>& columns);
absl::StatusOr<SweepTable> ReadSweepNpy(std::istream& stream, const std::vector<std::string>& columns);
absl::StatusOr<SweepTable> ReadSweepNetcdf(const std::string& path, const std::vector<std::string>& columns);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_SWEEP_SWEEP_FILE_H_
