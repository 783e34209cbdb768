// Reads the NetCDF-4 files that NetcdfFile writes.

#include <algorithm>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "client/cli/sweep/netcdf_library.h"
#include "client/cli/sweep/sweep_file.h"
#include "client/cli/sweep/sweep_rows.h"
#include "client/cli/text/field_table.h"
#include "core/base/try.h"

namespace ricochet::cli {
namespace {

struct Variable {
  std::string name;
  nc_type type = NC_NAT;
  std::vector<int> dimensions;
};

size_t PlaceOf(const std::string& name, const std::vector<Variable>& variables) {
  const auto found =
      std::find_if(variables.begin(), variables.end(), [&](const Variable& variable) { return variable.name == name; });
  return static_cast<size_t>(found - variables.begin());
}

// A file that is open for reading. It keeps the first error, after which all it returns is empty.
class File {
 public:
  explicit File(const std::string& path) { Take(Netcdf().open(path.c_str(), NC_NOWRITE, &id_)); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File() {
    if (id_ >= 0) Netcdf().close(id_);
  }

  absl::Status status() const {
    if (error_ == NC_NOERR) return absl::OkStatus();
    return absl::InvalidArgumentError(absl::StrCat("cannot be read as NetCDF: ", Netcdf().strerror(error_)));
  }

  // Returns an empty text for an attribute that is not there.
  std::string Text(int variable, const char* name) {
    size_t length = 0;
    nc_type type = NC_NAT;
    if (error_ != NC_NOERR || Netcdf().inq_att(id_, variable, name, &type, &length) != NC_NOERR || type != NC_CHAR)
      return "";
    std::string text(length, '\0');
    Take(Netcdf().get_att_text(id_, variable, name, text.data()));
    return text;
  }

  std::vector<Variable> Variables() {
    int count = 0;
    if (error_ == NC_NOERR) Take(Netcdf().inq_nvars(id_, &count));
    std::vector<Variable> variables(static_cast<size_t>(count));
    for (int i = 0; i < count && error_ == NC_NOERR; ++i) {
      Variable& variable = variables[static_cast<size_t>(i)];
      char name[NC_MAX_NAME + 1] = {};
      int dimensions[NC_MAX_VAR_DIMS] = {};
      int rank = 0;
      Take(Netcdf().inq_var(id_, i, name, &variable.type, &rank, dimensions, nullptr));
      variable.name = ColumnOfNetcdfName(name);
      variable.dimensions.assign(dimensions, dimensions + rank);
    }
    return variables;
  }

  std::string Name(int dimension) {
    char name[NC_MAX_NAME + 1] = {};
    if (error_ == NC_NOERR) Take(Netcdf().inq_dimname(id_, dimension, name));
    return name;
  }

  int64_t Length(int dimension) {
    size_t length = 0;
    if (error_ == NC_NOERR) Take(Netcdf().inq_dimlen(id_, dimension, &length));
    return static_cast<int64_t>(length);
  }

  // Returns the numbers of a variable over these dimensions, the last of which runs fastest.
  std::vector<double> Numbers(int variable, const std::vector<int>& dimensions) {
    size_t count = 1;
    for (const int dimension : dimensions) count *= static_cast<size_t>(Length(dimension));
    std::vector<double> numbers(count);
    if (error_ == NC_NOERR) Take(Netcdf().get_var_double(id_, variable, numbers.data()));
    return numbers;
  }

 private:
  void Take(int error) {
    if (error_ == NC_NOERR) error_ = error;
  }

  int id_ = -1;
  int error_ = NC_NOERR;
};

// Returns the paths of the axes: the coordinates of a list of points except their index, or the dimensions of a grid.
std::set<std::string> AxesOf(File& file, const std::vector<Variable>& variables) {
  std::set<std::string> axes;
  for (size_t i = 0; i < variables.size(); ++i) {
    for (const absl::string_view name :
         absl::StrSplit(file.Text(static_cast<int>(i), "coordinates"), ' ', absl::SkipEmpty())) {
      axes.emplace(name);
    }
    for (const int dimension : variables[i].dimensions) axes.insert(file.Name(dimension));
  }
  axes.erase("index");
  axes.erase("point");
  return axes;
}

// The contents of a file, in the order of its variables.
struct Contents {
  std::vector<int> dimensions;  // Every column has these.
  std::vector<int64_t> counts;  // The lengths of the dimensions.
  int64_t points = 1;
  std::vector<size_t> axes;
  std::vector<std::string> columns;
};

absl::StatusOr<Contents> ContentsOf(File& file, const std::vector<Variable>& variables) {
  if (file.status().ok() && file.Text(NC_GLOBAL, "ricochet_request").empty()) {
    return absl::InvalidArgumentError("has no attribute ricochet_request, so ricochet sweep did not write it");
  }
  Contents contents;
  const std::set<std::string> axes = AxesOf(file, variables);
  for (size_t i = 0; i < variables.size(); ++i) {
    const Variable& variable = variables[i];
    if (variable.dimensions.size() > contents.dimensions.size()) contents.dimensions = variable.dimensions;
    if (variable.type != NC_DOUBLE) continue;
    if (axes.count(variable.name) > 0) {
      contents.axes.push_back(i);
    } else {
      contents.columns.push_back(variable.name);
    }
  }
  for (const int dimension : contents.dimensions) {
    contents.counts.push_back(file.Length(dimension));
    // The lengths of a broken file are not to be believed: their product might overflow, or be 0 beside a huge one.
    if (contents.counts.back() < 0 || contents.counts.back() > SweepTable::kMostPoints) return TooManyPoints();
    if (contents.points <= SweepTable::kMostPoints) contents.points *= contents.counts.back();
  }
  if (!file.status().ok()) return file.status();
  if (contents.columns.empty()) return absl::InvalidArgumentError("has no column of numbers");
  if (contents.points > SweepTable::kMostPoints) return TooManyPoints();
  return contents;
}

// Returns the numbers of a variable that has one for each point.
// Errors: INVALID_ARGUMENT for any other.
absl::StatusOr<std::vector<double>> NumbersAtPoints(File& file, const std::vector<Variable>& variables,
                                                    const Contents& contents, size_t place) {
  const Variable& variable = variables[place];
  if (variable.dimensions == contents.dimensions) return file.Numbers(static_cast<int>(place), variable.dimensions);
  return absl::InvalidArgumentError(absl::StrCat("the variable ", variable.name, " must have a value for every point"));
}

// Returns the value of an axis at each point: that of one of the dimensions, or one for each point.
absl::StatusOr<std::vector<double>> AtPoints(File& file, const std::vector<Variable>& variables,
                                             const Contents& contents, size_t axis) {
  const std::vector<int>& own = variables[axis].dimensions;
  const auto found = own.size() == 1 ? std::find(contents.dimensions.begin(), contents.dimensions.end(), own[0])
                                     : contents.dimensions.end();
  if (found == contents.dimensions.end()) return NumbersAtPoints(file, variables, contents, axis);
  const auto place = static_cast<size_t>(found - contents.dimensions.begin());
  const int64_t count = contents.counts[place];
  // The points for which the axes after this one take all their values lie side by side.
  int64_t repeats = 1;
  for (size_t i = place + 1; i < contents.counts.size(); ++i) repeats *= contents.counts[i];
  const std::vector<double> values = file.Numbers(static_cast<int>(axis), own);
  std::vector<double> at;
  for (int64_t point = 0; point < contents.points; ++point) {
    at.push_back(values[static_cast<size_t>(point / repeats % count)]);
  }
  return at;
}

// Reads a variable whose numbers are those of an enum; a file need not have it.
template <typename Code>
absl::Status ReadCodes(File& file, const std::vector<Variable>& variables, const Contents& contents,
                       const std::string& name, int count, std::vector<Code>& codes) {
  const size_t variable = PlaceOf(name, variables);
  if (variable == variables.size()) return absl::OkStatus();
  RICOCHET_TRY(const std::vector<double> numbers, NumbersAtPoints(file, variables, contents, variable));
  for (const double number : numbers) {
    if (!(number >= 0.0 && number < count))
      return absl::InvalidArgumentError(absl::StrCat(name, " has a number that is no ", name));
    codes.push_back(static_cast<Code>(static_cast<int>(number)));
  }
  return absl::OkStatus();
}

// Adds the unit of a variable that the field table does not have.
void AddUnit(File& file, size_t variable, const std::string& name, SweepTable& table) {
  if (!UnitOfPath(name).empty() || FindFieldInfo(name) != nullptr) return;
  const std::string unit = file.Text(static_cast<int>(variable), "units");
  if (unit != "1") table.units[name] = unit;
}

}  // namespace

absl::StatusOr<SweepTable> ReadSweepNetcdf(const std::string& path, const std::vector<std::string>& columns) {
  if (absl::Status unusable = LoadNetcdf(); !unusable.ok()) return unusable;
  File file(path);
  const std::vector<Variable> variables = file.Variables();
  RICOCHET_TRY(const Contents contents, ContentsOf(file, variables));
  RICOCHET_TRY(std::vector<std::string> chosen, ChooseColumns(contents.columns, columns));
  SweepTable table;
  table.columns = std::move(chosen);
  for (const size_t axis : contents.axes) {
    table.axes.push_back(variables[axis].name);
    RICOCHET_TRY(std::vector<double> at, AtPoints(file, variables, contents, axis));
    table.at.push_back(std::move(at));
    AddUnit(file, axis, variables[axis].name, table);
  }
  for (const std::string& name : table.columns) {
    const size_t column = PlaceOf(name, variables);
    RICOCHET_TRY(std::vector<double> values, NumbersAtPoints(file, variables, contents, column));
    table.values.push_back(std::move(values));
    AddUnit(file, column, name, table);
  }
  absl::Status status = ReadCodes(file, variables, contents, "regime", kRegimeCount, table.regimes);
  status.Update(ReadCodes(file, variables, contents, "status", kRowStatusCount, table.statuses));
  if (!status.ok()) return status;
  if (!file.status().ok()) return file.status();
  return table;
}

}  // namespace ricochet::cli
