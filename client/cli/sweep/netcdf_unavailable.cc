// Stands in for netcdf_file.cc and netcdf_table.cc in a build without NetCDF.

#include "client/cli/sweep/netcdf_file.h"
#include "client/cli/sweep/sweep_file.h"

namespace ricochet::cli {

absl::StatusOr<std::unique_ptr<NetcdfFile>> NetcdfFile::Create(const SweepRequest& /*request*/,
                                                               const std::string& /*path*/) {
  return absl::UnimplementedError(
      "this build of ricochet cannot write NetCDF: choose csv, json or npy, or merge its shards with a build that was "
      "configured with -DRICOCHET_NETCDF=ON");
}

absl::StatusOr<SweepTable> ReadSweepNetcdf(const std::string& /*path*/, const std::vector<std::string>& /*columns*/) {
  return absl::UnimplementedError(
      "this build of ricochet cannot read NetCDF: take a file of csv or npy, or a build that was configured with "
      "-DRICOCHET_NETCDF=ON");
}

}  // namespace ricochet::cli
