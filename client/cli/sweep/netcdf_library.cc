#include "client/cli/sweep/netcdf_library.h"

#include <dlfcn.h>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"

namespace ricochet::cli {
namespace {

absl::Status Unusable(absl::string_view why) {
  return absl::FailedPreconditionError(
      absl::StrCat("NetCDF files need ", RICOCHET_NETCDF_LIBRARY, ", which cannot be loaded: ", why,
                   ". Install it (on Debian 12 the package libnetcdf19), or choose csv, json or npy"));
}

absl::Status Load(NetcdfLibrary& netcdf) {
  void* const library = dlopen(RICOCHET_NETCDF_LIBRARY, RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) return Unusable(dlerror());
  // At the end of the process HDF5 would close its files again, and crash if one could not be written. It must be told
  // before any other call of NetCDF.
  using LeaveAloneAtExit = int();
  if (auto* const leave = reinterpret_cast<LeaveAloneAtExit*>(dlsym(library, "H5dont_atexit"))) leave();
  netcdf = {.library = library};
  return netcdf.missing == nullptr ? absl::OkStatus() : Unusable(absl::StrCat("it has no function ", netcdf.missing));
}

struct Loaded {
  NetcdfLibrary netcdf;
  absl::Status status = Load(netcdf);
};

const Loaded& TheLibrary() {
  static const Loaded& loaded = *new Loaded;
  return loaded;
}

}  // namespace

NetcdfLibrary::Symbol NetcdfLibrary::Find(const char* name) {
  void* const address = library == nullptr ? nullptr : dlsym(library, name);
  if (address == nullptr && missing == nullptr) missing = name;
  return {address};
}

absl::Status LoadNetcdf() { return TheLibrary().status; }

const NetcdfLibrary& Netcdf() { return TheLibrary().netcdf; }

std::string NetcdfNameOf(const std::string& column) { return absl::StrReplaceAll(column, {{"/", "|"}}); }
std::string ColumnOfNetcdfName(const std::string& name) { return absl::StrReplaceAll(name, {{"|", "/"}}); }

}  // namespace ricochet::cli
