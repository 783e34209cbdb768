// The functions of libnetcdf that this program calls. The library brings some forty others with it, among them HDF5 and
// curl, whose loading takes as long as all else at the start of the program. So it is loaded when a NetCDF file is.

#ifndef RICOCHET_CLIENT_CLI_SWEEP_NETCDF_LIBRARY_H_
#define RICOCHET_CLIENT_CLI_SWEEP_NETCDF_LIBRARY_H_

#include <netcdf.h>

#include "absl/status/status.h"

namespace ricochet::cli {

// Each member is the function nc_... of its name.
struct NetcdfLibrary {
  decltype(&nc_abort) abort = nullptr;
  decltype(&nc_close) close = nullptr;
  decltype(&nc_create) create = nullptr;
  decltype(&nc_def_dim) def_dim = nullptr;
  decltype(&nc_def_var) def_var = nullptr;
  decltype(&nc_def_var_fill) def_var_fill = nullptr;
  decltype(&nc_enddef) enddef = nullptr;
  decltype(&nc_get_att_text) get_att_text = nullptr;
  decltype(&nc_get_var_double) get_var_double = nullptr;
  decltype(&nc_inq_att) inq_att = nullptr;
  decltype(&nc_inq_dimlen) inq_dimlen = nullptr;
  decltype(&nc_inq_dimname) inq_dimname = nullptr;
  decltype(&nc_inq_nvars) inq_nvars = nullptr;
  decltype(&nc_inq_var) inq_var = nullptr;
  decltype(&nc_open) open = nullptr;
  decltype(&nc_put_att_text) put_att_text = nullptr;
  decltype(&nc_put_att_uchar) put_att_uchar = nullptr;
  decltype(&nc_put_vara_double) put_vara_double = nullptr;
  decltype(&nc_put_vara_longlong) put_vara_longlong = nullptr;
  decltype(&nc_put_vara_uchar) put_vara_uchar = nullptr;
  decltype(&nc_strerror) strerror = nullptr;
};

// Loads the library, once. Errors: FAILED_PRECONDITION, with the name of the library, if that cannot be done.
absl::Status LoadNetcdf();

// A name in a NetCDF file must not have the slash of a derivative's name, for which it has a bar.
std::string NetcdfNameOf(const std::string& column);
std::string ColumnOfNetcdfName(const std::string& name);

// Returns the functions, which are null before LoadNetcdf has succeeded.
const NetcdfLibrary& Netcdf();

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_SWEEP_NETCDF_LIBRARY_H_
