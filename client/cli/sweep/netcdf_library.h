// The functions of libnetcdf that this program calls. The library brings some forty others with it, among them HDF5 and
// curl, whose loading takes as long as all else at the start of the program. So it is loaded when a NetCDF file is.

#ifndef RICOCHET_CLIENT_CLI_SWEEP_NETCDF_LIBRARY_H_
#define RICOCHET_CLIENT_CLI_SWEEP_NETCDF_LIBRARY_H_

#include <netcdf.h>

#include "absl/status/status.h"

namespace ricochet::cli {

struct NetcdfLibrary {
  // Symbol holds what dlsym has found, as a function of any type.
  struct Symbol {
    void* address = nullptr;

    template <typename Function>
    operator Function*() const {
      return reinterpret_cast<Function*>(address);
    }
  };
  // Finds a function, and notes the first that is missing.
  Symbol Find(const char* name);

  void* library = nullptr;
  const char* missing = nullptr;
  // Each is the function nc_... of its name.
  decltype(&nc_abort) abort = Find("nc_abort");
  decltype(&nc_close) close = Find("nc_close");
  decltype(&nc_create) create = Find("nc_create");
  decltype(&nc_def_dim) def_dim = Find("nc_def_dim");
  decltype(&nc_def_var) def_var = Find("nc_def_var");
  decltype(&nc_def_var_fill) def_var_fill = Find("nc_def_var_fill");
  decltype(&nc_enddef) enddef = Find("nc_enddef");
  decltype(&nc_get_att_text) get_att_text = Find("nc_get_att_text");
  decltype(&nc_get_var_double) get_var_double = Find("nc_get_var_double");
  decltype(&nc_inq_att) inq_att = Find("nc_inq_att");
  decltype(&nc_inq_dimlen) inq_dimlen = Find("nc_inq_dimlen");
  decltype(&nc_inq_dimname) inq_dimname = Find("nc_inq_dimname");
  decltype(&nc_inq_nvars) inq_nvars = Find("nc_inq_nvars");
  decltype(&nc_inq_var) inq_var = Find("nc_inq_var");
  decltype(&nc_open) open = Find("nc_open");
  decltype(&nc_put_att_text) put_att_text = Find("nc_put_att_text");
  decltype(&nc_put_att_uchar) put_att_uchar = Find("nc_put_att_uchar");
  decltype(&nc_put_vara_double) put_vara_double = Find("nc_put_vara_double");
  decltype(&nc_put_vara_longlong) put_vara_longlong = Find("nc_put_vara_longlong");
  decltype(&nc_put_vara_uchar) put_vara_uchar = Find("nc_put_vara_uchar");
  decltype(&nc_strerror) strerror = Find("nc_strerror");
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
