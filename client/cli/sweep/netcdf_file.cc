#include "client/cli/sweep/netcdf_file.h"

#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "client/cli/io/output.h"
#include "client/cli/sweep/netcdf_library.h"
#include "client/cli/text/axis_cursor.h"
#include "client/cli/text/enum_names.h"
#include "client/cli/text/field_table.h"
#include "core/base/try.h"
#include "core/rows/checked_rows.h"
#include "proto/wire/chunk_seal.h"
#include "proto/wire/sweep.h"

namespace ricochet::cli {
namespace {

// An error of NetCDF, and that of the system behind it or 0.
struct Failure {
  int error = NC_NOERR;
  int cause = 0;
};

// Call it right after the function that returned `error`. HDF5 says only that it has failed, and leaves errno as the
// disk set it; other values of errno are left by successes, too.
Failure FailureOf(int error) {
  const bool is_disk = errno == ENOSPC || errno == EDQUOT || errno == EFBIG || errno == EIO;
  // A positive number is one of the system.
  return {.error = error, .cause = is_disk ? errno : std::max(error, 0)};
}

absl::Status StatusOf(const Failure& failure) {
  constexpr char kWhat[] = "cannot write the NetCDF file";
  if (failure.error == NC_NOERR) return absl::OkStatus();
  if (failure.cause != 0) return absl::ErrnoToStatus(failure.cause, kWhat);
  return absl::InternalError(absl::StrCat(kWhat, ": ", Netcdf().strerror(failure.error)));
}

// Powers of units are written as UDUNITS reads them: "kg m2".
std::string UnitText(const std::string& unit) {
  if (unit.empty()) return "1";
  return absl::StrReplaceAll(unit, {{"²", "2"}, {"³", "3"}, {"·", " "}});
}

// Calls `put` with the corner and the edges of each block of the grid `counts` that the points [first, first + count)
// fill.
template <typename Put>
int ForEachBlock(const std::vector<size_t>& counts, size_t first, size_t count, Put put) {
  while (count > 0) {
    std::vector<size_t> corner(counts.size());
    std::vector<size_t> edges(counts.size(), 1);
    size_t rest = first;
    for (size_t d = counts.size(); d-- > 0;) {
      corner[d] = rest % counts[d];
      rest /= counts[d];
    }
    // The block takes whole rows, planes and so on as long as it starts at the beginning of one and reaches its end.
    size_t d = counts.size() - 1;
    size_t stride = 1;
    while (d > 0 && corner[d] == 0 && stride * counts[d] <= count) {
      edges[d] = counts[d];
      stride *= counts[d];
      --d;
    }
    edges[d] = std::min(counts[d] - corner[d], count / stride);
    const size_t taken = edges[d] * stride;
    if (const int error = put(corner, edges, taken); error != NC_NOERR) return error;
    first += taken;
    count -= taken;
  }
  return NC_NOERR;
}

class SweepFile final : public NetcdfFile {
 public:
  SweepFile(SweepRequest request, AtomicFile file)
      : request_(std::move(request)), file_(std::move(file)), cursor_(request_.grid) {}
  ~SweepFile() override {
    // To abort a file that could not be written crashes in NetCDF 4.9; it is removed all the same.
    if (id_ >= 0 && !has_failed()) Netcdf().abort(id_);
  }

  absl::Status Open(int64_t points) {
    Take(Netcdf().create(file_.temporary_path().c_str(), NC_CLOBBER | NC_NETCDF4, &id_));
    if (has_failed()) {
      id_ = -1;
      return StatusOf(failure_);
    }
    Define(points);
    if (!has_failed()) Take(Netcdf().enddef(id_));
    if (!is_flat_ && !has_failed()) PutAxes();
    return StatusOf(failure_);
  }

  absl::Status Write(const SweepChunk& chunk) override {
    if (!has_engine_ && !chunk.engine.fingerprint.empty()) PutEngine(chunk.engine);
    const auto count = static_cast<size_t>(chunk.count);
    const auto first = static_cast<size_t>(chunk.first_index - request_.first_index);
    for (size_t c = 0; c < columns_.size(); ++c) {
      const double* values = chunk.values.data() + c * count;
      Take(ForEachBlock(counts_, first, count, [&](const auto& corner, const auto& edges, size_t taken) {
        const double* const block = values;
        values += taken;
        return Netcdf().put_vara_double(id_, columns_[c], corner.data(), edges.data(), block);
      }));
    }
    if (request_.with_regime) {
      PutCodes(regime_, chunk.regimes, first);
      PutCodes(status_, chunk.statuses, first);
    }
    if (is_flat_) PutPoints(chunk, first);
    return StatusOf(failure_);
  }

  absl::Status Commit() override {
    Take(Netcdf().close(std::exchange(id_, -1)));
    return has_failed() ? StatusOf(failure_) : file_.Commit();
  }

 private:
  bool has_failed() const { return failure_.error != NC_NOERR; }
  // Keeps the first error.
  void Take(int error) {
    if (!has_failed() && error != NC_NOERR) failure_ = FailureOf(error);
  }

  void PutText(int variable, const char* name, const std::string& text) {
    Take(Netcdf().put_att_text(id_, variable, name, text.size(), text.data()));
  }

  int DefineVariable(const std::string& column, nc_type type, const std::vector<int>& dimensions) {
    int variable = -1;
    const std::string name = NetcdfNameOf(column);
    Take(Netcdf().def_var(id_, name.c_str(), type, static_cast<int>(dimensions.size()), dimensions.data(), &variable));
    // Every value is written, so that filling the file beforehand would write it twice.
    Take(Netcdf().def_var_fill(id_, variable, NC_NOFILL, nullptr));
    return variable;
  }

  int DefineNumber(const std::string& path, const std::vector<int>& dimensions) {
    const int variable = DefineVariable(path, NC_DOUBLE, dimensions);
    if (!IsInCoordinates(path)) PutText(variable, "units", UnitText(UnitOfPath(path)));
    const std::string meaning = MeaningOfPath(path);
    if (!meaning.empty()) PutText(variable, "long_name", meaning);
    return variable;
  }

  int DefineDimension(const std::string& name, int64_t count) {
    int dimension = -1;
    Take(Netcdf().def_dim(id_, name.c_str(), static_cast<size_t>(count), &dimension));
    counts_.push_back(static_cast<size_t>(count));
    return dimension;
  }

  void Define(int64_t points) {
    const Grid& grid = request_.grid;
    is_flat_ = grid.axes.empty() || grid.combination == Combination::kZip || points != PointCount(grid);
    std::vector<int> dimensions;
    if (is_flat_) {
      dimensions.push_back(DefineDimension("point", points));
      index_ = DefineVariable("index", NC_INT64, dimensions);
      PutText(index_, "long_name", "number of the point in the grid");
    } else {
      for (const Axis& axis : grid.axes) dimensions.push_back(DefineDimension(axis.path, AxisCount(axis)));
    }
    for (size_t i = 0; i < grid.axes.size(); ++i) {
      axes_.push_back(DefineNumber(grid.axes[i].path, {dimensions[is_flat_ ? 0 : i]}));
    }
    for (const std::string& column : request_.columns) columns_.push_back(DefineNumber(column, dimensions));
    if (request_.with_regime) {
      regime_ = DefineCodes<Regime, kRegimeCount>("regime", "what the contact did", RegimeName, dimensions);
      status_ = DefineCodes<RowStatus, kRowStatusCount>("status", "whether the point has numbers and is admissible",
                                                        StatusName, dimensions);
    }
    if (is_flat_) DefineCoordinates();
    DefineProvenance();
  }

  // Defines a variable of bytes, each of which stands for a value of an enum.
  template <typename Code, int kCount>
  int DefineCodes(const std::string& name, const std::string& meaning, const std::string& (*name_of)(Code),
                  const std::vector<int>& dimensions) {
    const int variable = DefineVariable(name, NC_UBYTE, dimensions);
    std::vector<unsigned char> numbers;
    std::vector<std::string> names;
    for (int i = 0; i < kCount; ++i) {
      numbers.push_back(static_cast<unsigned char>(i));
      names.push_back(name_of(static_cast<Code>(i)));
    }
    PutText(variable, "long_name", meaning);
    Take(Netcdf().put_att_uchar(id_, variable, "flag_values", NC_UBYTE, numbers.size(), numbers.data()));
    PutText(variable, "flag_meanings", absl::StrJoin(names, " "));
    return variable;
  }

  // Tells readers that the index and the axes are coordinates of the points.
  void DefineCoordinates() {
    std::vector<std::string> names = {"index"};
    for (const Axis& axis : request_.grid.axes) names.push_back(axis.path);
    const std::string coordinates = absl::StrJoin(names, " ");
    for (const int column : columns_) PutText(column, "coordinates", coordinates);
    if (!request_.with_regime) return;
    PutText(regime_, "coordinates", coordinates);
    PutText(status_, "coordinates", coordinates);
  }

  void DefineProvenance() {
    std::string request;
    const auto converted = google::protobuf::util::MessageToJsonString(ToProto(request_), &request);
    if (!converted.ok()) request.clear();
    PutText(NC_GLOBAL, "Conventions", "CF-1.8");
    PutText(NC_GLOBAL, "title", "Sweep of impacts with friction");
    PutText(NC_GLOBAL, "ricochet_request", request);
    PutText(NC_GLOBAL, "ricochet_grid_fingerprint", GridFingerprint(request_));
  }

  void PutEngine(const EngineInfo& engine) {
    has_engine_ = true;
    PutText(NC_GLOBAL, "source", absl::StrCat("ricochet ", engine.version));
    PutText(NC_GLOBAL, "ricochet_engine_fingerprint", engine.fingerprint);
  }

  void PutAxes() {
    constexpr size_t kValuesAtATime = 1 << 16;
    for (size_t i = 0; i < axes_.size(); ++i) {
      std::vector<double> values;
      for (size_t first = 0; first < counts_[i]; first += values.size()) {
        values.resize(std::min(kValuesAtATime, counts_[i] - first));
        for (size_t k = 0; k < values.size(); ++k) {
          values[k] = AxisValue(request_.grid.axes[i], static_cast<int64_t>(first + k));
        }
        const size_t count = values.size();
        Take(Netcdf().put_vara_double(id_, axes_[i], &first, &count, values.data()));
      }
    }
  }

  template <typename Code>
  void PutCodes(int variable, const std::vector<Code>& codes, size_t first) {
    std::vector<unsigned char> numbers;
    for (const Code code : codes) numbers.push_back(static_cast<unsigned char>(code));
    const unsigned char* next = numbers.data();
    Take(ForEachBlock(counts_, first, numbers.size(), [&](const auto& corner, const auto& edges, size_t taken) {
      const unsigned char* const block = next;
      next += taken;
      return Netcdf().put_vara_uchar(id_, variable, corner.data(), edges.data(), block);
    }));
  }

  // Writes the coordinates of points that do not form a grid.
  void PutPoints(const SweepChunk& chunk, size_t first) {
    const auto count = static_cast<size_t>(chunk.count);
    if (count == 0) return;
    std::vector<long long> indices(count);
    std::vector<std::vector<double>> values(axes_.size(), std::vector<double>(count));
    for (size_t k = 0; k < count; ++k) {
      indices[k] = chunk.first_index + static_cast<int64_t>(k);
      const std::vector<double>& point = cursor_.At(indices[k]);
      for (size_t i = 0; i < axes_.size(); ++i) values[i][k] = point[i];
    }
    Take(Netcdf().put_vara_longlong(id_, index_, &first, &count, indices.data()));
    for (size_t i = 0; i < axes_.size(); ++i) {
      Take(Netcdf().put_vara_double(id_, axes_[i], &first, &count, values[i].data()));
    }
  }

  SweepRequest request_;
  AtomicFile file_;
  AxisCursor cursor_;
  int id_ = -1;
  Failure failure_;
  bool is_flat_ = false;
  bool has_engine_ = false;
  std::vector<size_t> counts_;  // The lengths of the dimensions.
  int index_ = -1;
  int regime_ = -1;
  int status_ = -1;
  std::vector<int> axes_;
  std::vector<int> columns_;
};

}  // namespace

absl::StatusOr<std::unique_ptr<NetcdfFile>> NetcdfFile::Create(const SweepRequest& request, const std::string& path) {
  if (path.empty() || IsDevice(path)) {
    return absl::InvalidArgumentError("NetCDF needs -o FILE: it cannot be written to standard output or a device");
  }
  RICOCHET_TRY(const CheckedSweep checked, CheckSweep(request));
  if (absl::Status unusable = LoadNetcdf(); !unusable.ok()) return unusable;
  RICOCHET_TRY(AtomicFile file, AtomicFile::Create(path));
  // Equal ranges are always written in the same way, so that equal sweeps give equal files.
  SweepRequest written = request;
  written.end_index = checked.end;
  if (checked.first == 0 && checked.end == PointCount(checked.grid)) written.end_index.reset();
  auto sweep = std::make_unique<SweepFile>(std::move(written), std::move(file));
  if (absl::Status status = sweep->Open(checked.end - checked.first); !status.ok()) return status;
  return sweep;
}

}  // namespace ricochet::cli
