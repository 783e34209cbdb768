// What stands in for netcdf_file.cc in a build without NetCDF.

#include <utility>

#include "client/cli/netcdf_file.h"

namespace ricochet::cli {

class NetcdfFile::Impl {};

NetcdfFile::NetcdfFile(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
NetcdfFile::NetcdfFile(NetcdfFile&&) noexcept = default;
NetcdfFile::~NetcdfFile() = default;

absl::StatusOr<NetcdfFile> NetcdfFile::Create(const SweepRequest& /*request*/, const std::string& /*path*/) {
  return absl::UnimplementedError(
      "this build of ricochet cannot write NetCDF: choose csv, json or npy, or merge its shards with a build that was "
      "configured with -DRICOCHET_NETCDF=ON");
}

absl::Status NetcdfFile::Write(const SweepChunk& /*chunk*/) { return absl::OkStatus(); }
absl::Status NetcdfFile::Commit() { return absl::OkStatus(); }

}  // namespace ricochet::cli
