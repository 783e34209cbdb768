#include "python/module/columns.h"

#include <pybind11/numpy.h>

#include <algorithm>
#include <cstdint>
#include <limits>

#include "absl/strings/str_cat.h"
#include "core/base/invariant.h"

namespace ricochet::python {
namespace {

namespace py = pybind11;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;
using Rows = std::vector<const Message*>;

// A number that the message sets.
double NumberOf(const Message& message, const FieldDescriptor& field) {
  const Reflection& reflection = *message.GetReflection();
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return reflection.GetDouble(message, &field);
    case FieldDescriptor::CPPTYPE_INT32:
      return reflection.GetInt32(message, &field);
    case FieldDescriptor::CPPTYPE_BOOL:
      return reflection.GetBool(message, &field) ? 1.0 : 0.0;
    default:
      CheckInvariant(false, "the rows of an answer have fields of these kinds only");
      return 0.0;
  }
}

// Makes an array of get(row), or of `none` where get has no value.
template <typename Number, typename Has, typename Get>
py::array_t<Number> ArrayOf(const Rows& rows, Number none, Has has, Get get) {
  py::array_t<Number> array(static_cast<py::ssize_t>(rows.size()));
  std::transform(rows.begin(), rows.end(), array.mutable_data(), [&](const Message* row) {
    return row != nullptr && has(*row) ? static_cast<Number>(get(*row)) : none;
  });
  return array;
}

void AddList(const FieldDescriptor& field, const Rows& rows, const std::string& path, Columns& columns) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const auto size_in = [&](const Message& row) { return row.GetReflection()->FieldSize(row, &field); };
  int longest = 0;
  for (const Message* row : rows) longest = row == nullptr ? longest : std::max(longest, size_in(*row));
  for (int i = 0; i < longest; ++i) {
    columns.numbers[py::str(absl::StrCat(path, "[", i, "]"))] = ArrayOf(
        rows, kNone, [&](const Message& row) { return i < size_in(row); },
        [&](const Message& row) { return row.GetReflection()->GetRepeatedDouble(row, &field, i); });
  }
}

void AddColumn(const FieldDescriptor& field, const Rows& rows, const std::string& path, Columns& columns) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const auto has = [&](const Message& row) {
    return !field.has_presence() || row.GetReflection()->HasField(row, &field);
  };
  if (field.is_repeated()) return AddList(field, rows, path, columns);
  if (field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
    Rows inner;
    for (const Message* row : rows) {
      const bool is_set = row != nullptr && has(*row);
      inner.push_back(is_set ? &row->GetReflection()->GetMessage(*row, &field) : nullptr);
    }
    const bool is_empty = std::all_of(inner.begin(), inner.end(), [](const Message* row) { return row == nullptr; });
    if (rows.empty() || !is_empty) AddColumns(*field.message_type(), inner, absl::StrCat(path, "."), columns);
  } else if (field.cpp_type() == FieldDescriptor::CPPTYPE_ENUM) {
    columns.codes[py::str(path)] = ArrayOf<uint8_t>(
        rows, 0, has, [&](const Message& row) { return row.GetReflection()->GetEnumValue(row, &field); });
  } else {
    columns.numbers[py::str(path)] =
        ArrayOf(rows, kNone, has, [&](const Message& row) { return NumberOf(row, field); });
  }
}

}  // namespace

void AddColumns(const google::protobuf::Descriptor& type, const Rows& rows, const std::string& path, Columns& columns) {
  for (int i = 0; i < type.field_count(); ++i) {
    AddColumn(*type.field(i), rows, absl::StrCat(path, type.field(i)->name()), columns);
  }
}

}  // namespace ricochet::python
