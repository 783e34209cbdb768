// Reads the NPY files that MakeNpyWriter writes: one record for each point.

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"
#include "client/cli/io/npy_header.h"
#include "client/cli/sweep/sweep_file.h"
#include "client/cli/sweep/sweep_rows.h"
#include "core/base/try.h"

namespace ricochet::cli {
namespace {

static_assert(std::endian::native == std::endian::little, "records are read as they lie in memory");

constexpr size_t kRecordsAtATime = 4096;

struct Field {
  std::string name;
  std::string type;
};

struct NpyHeader {
  std::vector<Field> fields;
  int64_t records = 0;
};

absl::Status NotRecords(const std::string& why) {
  return absl::InvalidArgumentError(
      absl::StrCat(why, ": must be a list of records with named cells of <f8, <i8 and |u1, as ricochet sweep writes"));
}

// Returns the fields of a list such as [('index', '<i8'), ('pendulum.a_m', '<f8')].
std::vector<Field> FieldsIn(absl::string_view text) {
  std::vector<Field> fields;
  while (SkipPast("('", text)) {
    const absl::string_view name = TakeUntil('\'', text);
    if (!absl::ConsumePrefix(&text, "', '")) continue;
    const absl::string_view type = TakeUntil('\'', text);
    if (absl::ConsumePrefix(&text, "')")) fields.push_back({std::string(name), std::string(type)});
  }
  return fields;
}

absl::StatusOr<NpyHeader> ReadHeader(std::istream& stream) {
  RICOCHET_TRY(const std::string text, ReadNpyHeader(stream));
  NpyHeader header = {.fields = FieldsIn(text)};
  for (const auto& [name, type] : header.fields) {
    if (type != "<f8" && type != "<i8" && type != "|u1") return NotRecords(absl::StrCat(name, " has the type ", type));
  }
  if (header.fields.empty()) return NotRecords("its numbers have no names");
  const std::optional<std::vector<int64_t>> shape = ShapeIn(text);
  if (!shape.has_value() || shape->size() != 1) return NotRecords("it has more than one dimension");
  header.records = shape->front();
  return header;
}

template <typename Number>
Number Take(const char*& bytes) {
  Number number;
  std::memcpy(&number, bytes, sizeof(number));
  bytes += sizeof(number);
  return number;
}

absl::Status AddRecord(const std::vector<Field>& fields, const char*& bytes, SweepRows& rows) {
  for (size_t i = 0; i < fields.size(); ++i) {
    double value = 0.0;
    int64_t whole = 0;
    if (fields[i].type == "<f8") {
      value = Take<double>(bytes);
    } else {
      whole = fields[i].type == "<i8" ? Take<int64_t>(bytes) : Take<uint8_t>(bytes);
      value = static_cast<double>(whole);
    }
    if (rows.KindOf(i) == SweepRows::Kind::kSkipped) continue;
    if (rows.KindOf(i) == SweepRows::Kind::kNumber) {
      rows.AddNumber(i, value);
    } else if (absl::Status status = rows.AddCode(i, whole); !status.ok()) {
      return status;
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<SweepTable> ReadSweepNpy(std::istream& stream, const std::vector<std::string>& columns) {
  RICOCHET_TRY(const NpyHeader header, ReadHeader(stream));
  std::vector<std::string> names;
  size_t record_bytes = 0;
  for (const Field& field : header.fields) {
    names.push_back(field.name);
    record_bytes += field.type == "|u1" ? 1u : 8u;
  }
  RICOCHET_TRY(SweepRows rows, SweepRows::Create(names, columns));
  if (header.records > SweepTable::kMostPoints) return TooManyPoints();
  std::string bytes(kRecordsAtATime * record_bytes, '\0');
  const auto records = static_cast<size_t>(header.records);
  for (size_t done = 0; done < records;) {
    const size_t count = std::min(kRecordsAtATime, records - done);
    stream.read(bytes.data(), static_cast<std::streamsize>(count * record_bytes));
    const size_t read = static_cast<size_t>(stream.gcount()) / record_bytes;
    if (read < count) {
      return absl::InvalidArgumentError(absl::StrCat("ends after ", done + read, " of its ", records, " records"));
    }
    const char* next = bytes.data();
    for (size_t i = 0; i < count; ++i) {
      if (absl::Status status = AddRecord(header.fields, next, rows); !status.ok()) return status;
    }
    done += count;
  }
  return std::move(rows.table());
}

}  // namespace ricochet::cli
