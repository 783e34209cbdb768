// NetcdfFile: a sweep as a NetCDF-4 file with the conventions CF-1.8, which xarray, MATLAB, Julia and R open.
//
// A sweep over a whole grid has a dimension for each axis, with the values of the axis as its coordinate; the last axis
// runs fastest. A zip, a part of a grid, or a grid without axes has the one dimension `point`, with the grid's `index`
// and the axes as coordinates. Columns are variables of doubles, an invalid point is NaN, and the regime and the status
// are variables of bytes with their numbers and names as attributes. Global attributes tell the request, the grid and
// the engine.

#ifndef RICOCHET_CLIENT_CLI_SWEEP_NETCDF_FILE_H_
#define RICOCHET_CLIENT_CLI_SWEEP_NETCDF_FILE_H_

#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "ricochet/sweep.h"

namespace ricochet::cli {

// Memory does not depend on the number of points. The file appears under its name when it is complete.
class NetcdfFile {
 public:
  // Errors: UNIMPLEMENTED if this build has no NetCDF; INVALID_ARGUMENT for an empty path, which is standard output, a
  // device, or a wrong request; those of the system.
  static absl::StatusOr<std::unique_ptr<NetcdfFile>> Create(const SweepRequest& request, const std::string& path);

  NetcdfFile() = default;
  NetcdfFile(const NetcdfFile&) = delete;
  NetcdfFile& operator=(const NetcdfFile&) = delete;
  virtual ~NetcdfFile() = default;

  // Writes the next chunk. Errors: those of the system.
  virtual absl::Status Write(const SweepChunk& chunk) = 0;
  // Call it once, after the last Write. Errors: those of the system.
  virtual absl::Status Commit() = 0;
};

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_SWEEP_NETCDF_FILE_H_
