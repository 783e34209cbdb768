#include "client/cli/sweep/netcdf_library.h"

#include <dlfcn.h>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"

namespace ricochet::cli {
namespace {

// Finds functions in a loaded library and remembers the first that is missing.
struct Finder {
  void* library = nullptr;
  const char* missing = nullptr;

  template <typename Function>
  void operator()(const char* name, Function*& function) {
    function = reinterpret_cast<Function*>(dlsym(library, name));
    if (function == nullptr && missing == nullptr) missing = name;
  }
};

absl::Status Unusable(absl::string_view why) {
  return absl::FailedPreconditionError(
      absl::StrCat("NetCDF files need ", RICOCHET_NETCDF_LIBRARY, ", which cannot be loaded: ", why,
                   ". Install it (on Debian 12 the package libnetcdf19), or choose csv, json or npy"));
}

absl::Status Load(NetcdfLibrary& netcdf) {
  void* const library = dlopen(RICOCHET_NETCDF_LIBRARY, RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) return Unusable(dlerror());
  // HDF5 would close its files once more when the process ends, and crashes there if one could not be written. This
  // comes before anything else of NetCDF.
  using LeaveAloneAtExit = int();
  if (auto* const leave = reinterpret_cast<LeaveAloneAtExit*>(dlsym(library, "H5dont_atexit"))) leave();
  Finder find = {.library = library};
  find("nc_abort", netcdf.abort);
  find("nc_close", netcdf.close);
  find("nc_create", netcdf.create);
  find("nc_def_dim", netcdf.def_dim);
  find("nc_def_var", netcdf.def_var);
  find("nc_def_var_fill", netcdf.def_var_fill);
  find("nc_enddef", netcdf.enddef);
  find("nc_get_att_text", netcdf.get_att_text);
  find("nc_get_var_double", netcdf.get_var_double);
  find("nc_inq_att", netcdf.inq_att);
  find("nc_inq_dimlen", netcdf.inq_dimlen);
  find("nc_inq_dimname", netcdf.inq_dimname);
  find("nc_inq_nvars", netcdf.inq_nvars);
  find("nc_inq_var", netcdf.inq_var);
  find("nc_open", netcdf.open);
  find("nc_put_att_text", netcdf.put_att_text);
  find("nc_put_att_uchar", netcdf.put_att_uchar);
  find("nc_put_vara_double", netcdf.put_vara_double);
  find("nc_put_vara_longlong", netcdf.put_vara_longlong);
  find("nc_put_vara_uchar", netcdf.put_vara_uchar);
  find("nc_strerror", netcdf.strerror);
  return find.missing == nullptr ? absl::OkStatus() : Unusable(absl::StrCat("it has no function ", find.missing));
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

absl::Status LoadNetcdf() { return TheLibrary().status; }

const NetcdfLibrary& Netcdf() { return TheLibrary().netcdf; }

std::string NetcdfNameOf(const std::string& column) { return absl::StrReplaceAll(column, {{"/", "|"}}); }
std::string ColumnOfNetcdfName(const std::string& name) { return absl::StrReplaceAll(name, {{"|", "/"}}); }

}  // namespace ricochet::cli
