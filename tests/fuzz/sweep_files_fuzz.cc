// Fuzzes the reading of files of sweeps for pictures. The first byte says whether the others are a file as it is, in
// CSV, JSON or NPY, or build a NetCDF file: its dimensions, variables and attributes, which are whole, because the
// library that reads their bytes is not ours. The second byte says whether one column is wanted or all.
//
// It checks that a file is read or refused with a reason that names it, and that the table which was read fits
// together: axes and columns have a number for each point, regimes and statuses are there for all points or none, and
// are such.
//
// tests/fuzz/run.sh lists the code that it covers.

#include <netcdf.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/cli/sweep/sweep_file.h"
#include "tests/fuzz/bytes.h"
#include "tests/fuzz/fail.h"
#include "tests/support/processes/temporary_directory.h"

namespace ricochet::cli {
namespace {

constexpr const char* kNames[] = {"pendulum.a_m",
                                  "friction.kinetic_coefficient",
                                  "coefficients.newton",
                                  "coefficients.poisson",
                                  "regime",
                                  "status",
                                  "index",
                                  "point",
                                  "energy_change_j",
                                  "nobody.knows"};
constexpr nc_type kTypes[] = {NC_DOUBLE, NC_DOUBLE, NC_BYTE, NC_CHAR, NC_FLOAT, NC_INT};
constexpr size_t kLongest = 6;  // The most in a dimension.

void PutText(int file, int variable, const char* name, const std::string& text) {
  nc_put_att_text(file, variable, name, text.size(), text.data());
}

void PutVariable(int file, const std::vector<int>& dimensions, Bytes& bytes, size_t& values) {
  std::vector<int> own;
  const uint8_t which = bytes.Byte();
  for (size_t i = 0; i < dimensions.size(); ++i) {
    if ((which >> i & 1U) != 0) own.push_back(dimensions[i]);
  }
  int variable = -1;
  const nc_type type = kTypes[bytes.Byte() % std::size(kTypes)];
  if (nc_def_var(file, kNames[bytes.Byte() % std::size(kNames)], type, static_cast<int>(own.size()), own.data(),
                 &variable) != NC_NOERR) {
    return;
  }
  const uint8_t attributes = bytes.Byte();
  if ((attributes & 1U) != 0) PutText(file, variable, "coordinates", "index pendulum.a_m");
  if ((attributes & 2U) != 0) PutText(file, variable, "units", "m");
  if (type == NC_CHAR) return;
  size_t count = 1;
  for (const int dimension : own) {
    size_t length = 0;
    nc_inq_dimlen(file, dimension, &length);
    count *= length;
  }
  std::vector<double> numbers(count);
  // A byte is a regime or a status at times; other numbers are those that none can be.
  for (double& number : numbers) {
    number = static_cast<double>(bytes.Byte()) - 4.0;
    if (type == NC_DOUBLE && number > 240.0) number = number > 245.0 ? NAN : INFINITY;
  }
  nc_enddef(file);
  nc_put_var_double(file, variable, numbers.data());
  values += count;
}

void WriteNetcdf(const std::string& path, Bytes& bytes) {
  const uint8_t shape = bytes.Byte();
  int file = -1;
  if (nc_create(path.c_str(), (shape & 1U) != 0 ? NC_NETCDF4 : NC_64BIT_OFFSET, &file) != NC_NOERR) {
    Fail("no file can be made");
  }
  if ((shape & 2U) == 0) PutText(file, NC_GLOBAL, "ricochet_request", "{}");
  std::vector<int> dimensions;
  for (unsigned i = 0; i < (shape >> 2 & 3U); ++i) {
    int dimension = -1;
    const char* const name = kNames[bytes.Byte() % std::size(kNames)];
    if (nc_def_dim(file, name, bytes.Byte() % kLongest + 1, &dimension) == NC_NOERR) dimensions.push_back(dimension);
  }
  size_t values = 0;
  for (unsigned i = 0; i < 8 && !bytes.empty() && values < 4096; ++i) {
    PutVariable(file, dimensions, bytes, values);
    // A file of the older format takes definitions and numbers in turns.
    nc_redef(file);
  }
  nc_close(file);
}

void CheckTable(const SweepTable& table, size_t most_columns) {
  if (table.at.size() != table.axes.size()) Fail("another number of axes than of their names");
  if (table.values.size() != table.columns.size()) Fail("another number of columns than of their names");
  if (table.columns.empty() || table.columns.size() > most_columns) Fail("other columns than were wanted");
  const size_t points = table.values.front().size();
  for (const std::vector<double>& axis : table.at) {
    if (axis.size() != points) Fail(absl::StrCat("an axis of ", axis.size(), " values for ", points, " points"));
  }
  for (const std::vector<double>& column : table.values) {
    if (column.size() != points) Fail(absl::StrCat("a column of ", column.size(), " values for ", points, " points"));
  }
  if (!table.regimes.empty() && table.regimes.size() != points) Fail("another number of regimes than of points");
  if (!table.statuses.empty() && table.statuses.size() != points) Fail("another number of statuses than of points");
  for (const Regime regime : table.regimes) {
    if (static_cast<int>(regime) < 0 || static_cast<int>(regime) >= kRegimeCount) Fail("a regime that is none");
  }
  for (const RowStatus status : table.statuses) {
    if (static_cast<int>(status) >= kRowStatusCount) Fail("a status that is none");
  }
}

void CheckFile(const std::string& path, bool wants_one) {
  std::vector<std::string> columns;
  if (wants_one) columns = {"coefficients.newton"};
  const absl::StatusOr<SweepTable> table = ReadSweepFile(path, columns);
  if (table.ok()) return CheckTable(*table, wants_one ? 1 : 1000);
  const bool is_promised = absl::IsInvalidArgument(table.status()) || absl::IsFailedPrecondition(table.status());
  if (!is_promised || !absl::StrContains(table.status().message(), path)) Fail(table.status().ToString());
}

void Run(Bytes bytes) {
  static const TemporaryDirectory directory;
  const bool is_netcdf = bytes.Byte() % 2 != 0;
  const bool wants_one = bytes.Byte() % 2 != 0;
  const std::string path = directory / "sweep";
  if (is_netcdf) {
    WriteNetcdf(path, bytes);
  } else {
    std::ofstream(path, std::ios::binary) << bytes.Rest();
  }
  CheckFile(path, wants_one);
}

}  // namespace
}  // namespace ricochet::cli

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  ricochet::cli::Run(ricochet::Bytes(data, size));
  return 0;
}
