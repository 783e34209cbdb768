#include "client/cli/input/mechanism_file.h"

#include <zip.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <memory>
#include <sstream>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/cli/io/npy_header.h"
#include "core/base/try.h"

namespace ricochet::cli {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are read as they lie in memory");

// An array of a mechanism of a thousand coordinates has 8 MB.
constexpr uint64_t kMostBytes = uint64_t{1} << 28;

struct Array {
  std::vector<int64_t> shape;
  std::vector<double> numbers;  // Row by row.
};

struct CloseZip {
  void operator()(zip_t* archive) const { zip_discard(archive); }
  void operator()(zip_file_t* file) const { zip_fclose(file); }
};
using Archive = std::unique_ptr<zip_t, CloseZip>;

absl::StatusOr<Archive> Open(const std::string& path) {
  int code = 0;
  Archive archive(zip_open(path.c_str(), ZIP_RDONLY, &code));
  if (archive != nullptr) return archive;
  zip_error_t error;
  zip_error_init_with_code(&error, code);
  const std::string why = zip_error_strerror(&error);
  zip_error_fini(&error);
  return absl::InvalidArgumentError(absl::StrCat(why,
                                                 ": must be a file that numpy.savez has written, with the arrays M, "
                                                 "J and qdot"));
}

std::string NamesIn(zip_t* archive) {
  std::vector<std::string> names;
  for (zip_int64_t i = 0; i < zip_get_num_entries(archive, 0); ++i) {
    const char* const name = zip_get_name(archive, static_cast<zip_uint64_t>(i), 0);
    if (name != nullptr) names.emplace_back(name);
  }
  return names.empty() ? "nothing" : absl::StrJoin(names, ", ");
}

absl::StatusOr<std::string> BytesOf(zip_t* archive, const std::string& name) {
  zip_stat_t stat;
  if (zip_stat(archive, absl::StrCat(name, ".npy").c_str(), 0, &stat) != 0) {
    return absl::InvalidArgumentError(absl::StrCat("has no array ", name, " but ", NamesIn(archive),
                                                   ": must have M, J and qdot, as numpy.savez(FILE, M=M, J=J, "
                                                   "qdot=qdot) writes them"));
  }
  if (stat.size > kMostBytes) return absl::InvalidArgumentError(absl::StrCat(name, " has ", stat.size, " bytes"));
  std::string bytes(stat.size, '\0');
  const std::unique_ptr<zip_file_t, CloseZip> file(zip_fopen_index(archive, stat.index, 0));
  if (file == nullptr || zip_fread(file.get(), bytes.data(), bytes.size()) != static_cast<zip_int64_t>(bytes.size())) {
    return absl::InvalidArgumentError(absl::StrCat(name, " cannot be unpacked"));
  }
  // libzip compares the checksum where the end is read.
  char beyond = 0;
  if (zip_fread(file.get(), &beyond, 1) != 0) {
    return absl::InvalidArgumentError(absl::StrCat(name, " is damaged: its checksum is wrong"));
  }
  return bytes;
}

template <typename Number>
std::vector<double> NumbersOf(const std::string& bytes) {
  std::vector<Number> numbers(bytes.size() / sizeof(Number));
  std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(Number));
  return {numbers.begin(), numbers.end()};
}

// The numbers of an array whose type NumPy spells `type`; nothing for another type.
std::optional<std::vector<double>> NumbersOf(absl::string_view type, const std::string& bytes) {
  if (type == "<f8") return NumbersOf<double>(bytes);
  if (type == "<f4") return NumbersOf<float>(bytes);
  if (type == "<i8") return NumbersOf<int64_t>(bytes);
  if (type == "<i4") return NumbersOf<int32_t>(bytes);
  return std::nullopt;
}

// Puts a matrix that lies column by column into rows.
void Transpose(Array& array) {
  const auto rows = static_cast<size_t>(array.shape[0]);
  const auto columns = static_cast<size_t>(array.shape[1]);
  const std::vector<double> by_column = std::exchange(array.numbers, std::vector<double>(rows * columns));
  for (size_t i = 0; i < rows; ++i) {
    for (size_t j = 0; j < columns; ++j) array.numbers[i * columns + j] = by_column[j * rows + i];
  }
}

absl::StatusOr<Array> ReadArray(zip_t* archive, const std::string& name) {
  RICOCHET_TRY(const std::string bytes, BytesOf(archive, name));
  std::istringstream stream(bytes);
  const absl::StatusOr<std::string> header = ReadNpyHeader(stream);
  if (!header.ok()) return absl::InvalidArgumentError(absl::StrCat(name, " ", header.status().message()));
  absl::string_view descr = *header;
  const bool has_type = SkipPast("'descr': '", descr);
  const absl::string_view type = TakeUntil('\'', descr);
  const std::optional<std::vector<int64_t>> shape = ShapeIn(*header);
  std::optional<std::vector<double>> numbers;
  if (has_type) numbers = NumbersOf(type, bytes.substr(static_cast<size_t>(stream.tellg())));
  if (!numbers.has_value() || !shape.has_value()) {
    return absl::InvalidArgumentError(absl::StrCat(name, " has the type ", has_type ? type : "of a record",
                                                   ": must be float64, as ", name, ".astype(float) is"));
  }
  Array array = {.shape = *shape, .numbers = *std::move(numbers)};
  double count = 1.0;
  for (const int64_t length : array.shape) count *= static_cast<double>(length);
  if (count != static_cast<double>(array.numbers.size())) {
    return absl::InvalidArgumentError(
        absl::StrCat(name, " has ", array.numbers.size(), " numbers, not those of its shape"));
  }
  if (array.shape.size() == 2 && header->find("'fortran_order': True") != std::string::npos) Transpose(array);
  return array;
}

std::string ShapeText(const std::vector<int64_t>& shape) {
  return absl::StrCat("(", absl::StrJoin(shape, ", "), shape.size() == 1 ? ",)" : ")");
}

// Returns what the shape of J must be.
std::string ShapeOfJacobian(int64_t n, int64_t contacts, bool has_more_rows) {
  if (contacts > 1) {
    return absl::StrCat("be (", 2 * contacts, ", ", n, ") with rows t, n for each of the ", contacts, " contacts or (",
                        3 * contacts, ", ", n, ") with rows t1, t2, n");
  }
  return absl::StrCat(
      "be (2, ", n, ") with rows t, n or (3, ", n, ") with rows t1, t2, n",
      has_more_rows ? "; for several contacts `ricochet multicontact` takes a number of --mu for each" : "");
}

absl::StatusOr<Mechanism> Read(const std::string& path, int64_t contacts) {
  RICOCHET_TRY(const Archive archive, Open(path));
  Mechanism mechanism;
  // The rates come first, as they tell n.
  RICOCHET_TRY(const Array rates, ReadArray(archive.get(), "qdot"));
  const auto n = static_cast<int64_t>(rates.numbers.size());
  const auto check = [](const char* name, const Array& array, bool holds, const std::string& rule) {
    if (holds) return absl::OkStatus();
    return absl::InvalidArgumentError(absl::StrCat(name, " has the shape ", ShapeText(array.shape), ": must ", rule));
  };
  using Shape = std::vector<int64_t>;
  absl::Status status = check("qdot", rates, rates.shape.size() == 1 && n > 0, "be (n,), with n at least 1");
  if (!status.ok()) return status;
  RICOCHET_TRY(const Array mass, ReadArray(archive.get(), "M"));
  status = check("M", mass, mass.shape == Shape{n, n}, absl::StrCat("be (", n, ", ", n, ") for the ", n, " of qdot"));
  if (!status.ok()) return status;
  RICOCHET_TRY(const Array jacobian, ReadArray(archive.get(), "J"));
  const Shape& shape = jacobian.shape;
  status = check("J", jacobian, shape == Shape{2 * contacts, n} || shape == Shape{3 * contacts, n},
                 ShapeOfJacobian(n, contacts, !shape.empty() && shape[0] > 3));
  if (!status.ok()) return status;
  return Mechanism{.mass_matrix = mass.numbers, .jacobian = jacobian.numbers, .rates = rates.numbers};
}

}  // namespace

absl::StatusOr<Mechanism> ReadMechanism(const std::string& path, int64_t contacts) {
  absl::StatusOr<Mechanism> mechanism = Read(path, contacts);
  if (mechanism.ok()) return mechanism;
  return absl::InvalidArgumentError(absl::StrCat(path, ": ", mechanism.status().message()));
}

}  // namespace ricochet::cli
