#include "python/module/filler.h"

#include <google/protobuf/descriptor.h>
#include <pybind11/numpy.h>

#include <cstdint>
#include <span>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "core/base/invariant.h"
#include "core/base/try.h"
#include "proto/wire/enums.h"
#include "python/module/exceptions.h"
#include "python/module/record.h"
#include "ricochet/contact_matrix.h"
#include "ricochet/v1/multi_contact.pb.h"
#include "ricochet/v1/scene.pb.h"

namespace ricochet::python {
namespace {

using google::protobuf::EnumDescriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Reflection;

// The arguments of Python whose field is called otherwise.
constexpr std::pair<const char*, const char*> kFields[] = {
    {"tolerance", "relative_tolerance"}, {"require", "required"},          {"exclude", "excluded"},
    {"strict", "inadmissible_is_error"}, {"history", "history_intervals"}, {"force_history", "force_intervals"},
    {"certified", "certified_digits"}};

const FieldDescriptor& FieldOf(const google::protobuf::Message& message, absl::string_view argument) {
  std::string name(argument);
  for (const auto& [python, field] : kFields) {
    if (argument == python) name = field;
  }
  const FieldDescriptor* const field = message.GetDescriptor()->FindFieldByName(name);
  CheckInvariant(field != nullptr, "an argument of Python is a field of its request");
  return *field;
}

bool IsNothing(PyObject* value) {
  return value == Py_None || (PyTuple_CheckExact(value) && PyTuple_GET_SIZE(value) == 0);
}

bool IsZeroOrFalse(PyObject* value) {
  return value == Py_False || (PyLong_CheckExact(value) && PyObject_IsTrue(value) == 0);
}

// Returns whether the field may be None. In a field without presence, None would silently become 0.
bool MayBeAbsent(const FieldDescriptor& field) { return field.has_presence() || field.is_repeated(); }

// Returns the text of a str; nothing for another object, or for a text that cannot be encoded.
std::optional<absl::string_view> Utf8(PyObject* value) {
  if (!PyUnicode_Check(value)) return std::nullopt;
  Py_ssize_t size = 0;
  const char* const text = PyUnicode_AsUTF8AndSize(value, &size);
  if (text != nullptr) return absl::string_view(text, static_cast<size_t>(size));
  PyErr_Clear();
  return std::nullopt;
}

// Returns whether `values` is a dictionary or another mapping, and sets `dictionary` to it.
bool ReadDictionary(py::handle values, py::dict& dictionary) {
  if (PyDict_CheckExact(values.ptr())) {
    dictionary = py::reinterpret_borrow<py::dict>(values);
    return true;
  }
  if (!py::isinstance(values, PythonName("collections.abc", "Mapping"))) return false;
  dictionary = PythonName("builtins", "dict")(values);
  return true;
}

// Returns whether the value of a message may be a matrix: W of a contact, M or J of a mechanism.
bool MayBeMatrix(const google::protobuf::Descriptor& type, absl::string_view name) {
  if (&type == v1::Mechanism::descriptor()) return name == "mass_matrix" || name == "jacobian";
  return name == "w_per_kg" && (&type == v1::PlanarContact::descriptor() || &type == v1::SpatialContact::descriptor() ||
                                &type == v1::ContactMatrix::descriptor());
}

using Matrix = py::array_t<double, py::array::c_style>;

// Returns whether a message lists all entries of its matrices, row by row.
bool ListsAllEntries(const google::protobuf::Descriptor& type) {
  return &type == v1::Mechanism::descriptor() || &type == v1::ContactMatrix::descriptor();
}

// Returns whether so many numbers are the entries of the matrix, in place of the matrix itself.
bool IsList(const google::protobuf::Descriptor& type, py::ssize_t size) {
  return ListsAllEntries(type) || (&type == v1::SpatialContact::descriptor() && size == 6);
}

// Returns the shape that J must have beside so many rates, none of which may be known; nothing if it has that. Its
// numbers alone do not tell it from its transpose. Several contacts have rows of J each, and the rules of the scene
// check how many.
std::string RuleForJacobian(py::ssize_t rows, py::ssize_t columns, int rates, bool has_several_contacts) {
  const bool has_rows = rows == 2 || rows == 3 || (rows > 3 && has_several_contacts);
  if (has_rows && (rates == 0 || columns == rates)) return "";
  const std::string n = rates == 0 ? "n" : absl::StrCat(rates);
  if (has_several_contacts) return absl::StrCat("(d, ", n, "), with the rows t, n or t1, t2, n of each contact");
  return absl::StrCat("(2, ", n, ") with rows t, n or (3, ", n, ") with rows t1, t2, n");
}

// Returns the shape that a matrix must have; nothing if it has that.
std::string RuleForShape(const google::protobuf::Descriptor& type, absl::string_view name, const Matrix& matrix,
                         int rates, bool has_several_contacts) {
  const py::ssize_t rows = matrix.ndim() == 2 ? matrix.shape(0) : 0;
  const py::ssize_t columns = matrix.ndim() == 2 ? matrix.shape(1) : 0;
  const auto is_square = [&](py::ssize_t size) { return rows == size && columns == size; };
  if (name == "mass_matrix") return rows > 0 && rows == columns ? "" : "n x n";
  if (name == "jacobian") return RuleForJacobian(rows, columns, rates, has_several_contacts);
  if (&type == v1::ContactMatrix::descriptor()) return rows > 0 && rows == columns ? "" : "a symmetric square matrix";
  if (&type == v1::PlanarContact::descriptor()) return is_square(2) ? "" : "a symmetric 2 x 2 matrix";
  return is_square(3) ? "" : "a symmetric 3 x 3 matrix, or its entries 11, 12, 13, 22, 23, 33 in this order";
}

// Sets the entries of W in the message of a contact.
absl::Status PackW(const Matrix& w, google::protobuf::Message& message) {
  if (w.size() == 4) {
    RICOCHET_TRY(const auto contact, ContactFrom(std::span<const double, 4>(w.data(), 4), 0.0, 0.0));
    auto& planar = dynamic_cast<v1::PlanarContact&>(message);
    planar.set_w_tt_per_kg(contact.w_tt_per_kg);
    planar.set_w_tn_per_kg(contact.w_tn_per_kg);
    planar.set_w_nn_per_kg(contact.w_nn_per_kg);
    return absl::OkStatus();
  }
  RICOCHET_TRY(const auto contact, ContactFrom(std::span<const double, 9>(w.data(), 9), {}, 0.0));
  auto& spatial = dynamic_cast<v1::SpatialContact&>(message);
  spatial.mutable_w_per_kg()->Assign(contact.w_per_kg.begin(), contact.w_per_kg.end());
  return absl::OkStatus();
}

// Returns whether `value` is a plain list of six numbers, of which no array need be made.
bool HasSixNumbers(PyObject* value) {
  return PyList_CheckExact(value) && PyList_GET_SIZE(value) == 6 && PyFloat_Check(PyList_GET_ITEM(value, 0));
}

}  // namespace

std::string Place::Text() const {
  std::string text = outer == nullptr ? "" : absl::StrCat(outer->Text(), ".");
  absl::StrAppend(&text, name);
  if (index >= 0) absl::StrAppend(&text, "[", index, "]");
  return text;
}

template <typename... Arguments>
py::object Filler::Ask(const char* name, Arguments&&... arguments) {
  try {
    return PythonName("ricochet.values", name)(std::forward<Arguments>(arguments)...);
  } catch (const py::error_already_set& error) {
    if (!error.matches(PythonName("ricochet.errors", "InvalidRequest"))) throw;
    for (const py::handle violation : error.value().attr("violations")) {
      violations_.push_back({py::str(violation.attr("field")), py::str(violation.attr("description"))});
    }
    return {};
  }
}

void Filler::Fill(py::handle values, Message& message, const Place* place) {
  py::dict dictionary;
  const google::protobuf::Descriptor& type = *message.GetDescriptor();
  if (!ReadDictionary(values, dictionary)) {
    Ask("dictionary_expected", values, place == nullptr ? "scene" : place->Text(), FieldNames(type));
    return;
  }
  has_several_contacts_ = has_several_contacts_ || &type == v1::MultiContactScene::descriptor();
  for (const bool is_matrix : {false, true}) {  // The shape of J follows from the rates.
    for (const auto& [key, value] : dictionary) {
      const auto name = Utf8(key.ptr());
      if (is_matrix != (name.has_value() && MayBeMatrix(type, *name))) continue;
      // Python may be asked what the value is, and may change the dictionary then.
      const auto held = py::reinterpret_borrow<py::object>(value);
      const Place there = {.outer = place, .name = name.value_or("")};
      if (is_matrix && FillMatrix(held, message, there, dictionary)) continue;
      const FieldDescriptor* const field = name.has_value() ? type.FindFieldByName(std::string(*name)) : nullptr;
      if (field == nullptr) {
        const std::string shown = py::str(key);
        Ask("unknown_field", Place{.outer = place, .name = shown}.Text(), key, FieldNames(type));
      } else if (!held.is_none() || !MayBeAbsent(*field)) {
        FillField(held, message, *field, there);
      }
    }
  }
}

bool Filler::FillMatrix(py::handle value, Message& message, const Place& place, const py::dict& beside) {
  const auto& type = *message.GetDescriptor();
  if (value.is_none() || (HasSixNumbers(value.ptr()) && IsList(type, 6))) return false;
  const py::object column = Ask("column", value, place.Text());
  if (!column) return true;
  const Matrix matrix = Matrix::ensure(column);
  if (matrix.ndim() == 1 && IsList(type, matrix.size())) return false;
  const auto* const mechanism = dynamic_cast<const v1::Mechanism*>(&message);
  const int rates = mechanism != nullptr && violations_.empty() ? mechanism->rates_size() : 0;
  if (const std::string rule = RuleForShape(type, place.name, matrix, rates, has_several_contacts_); !rule.empty()) {
    Refuse(place, absl::StrCat("has shape ", std::string(py::str(matrix.attr("shape"))), ": must be ", rule));
    return true;
  }
  if (ListsAllEntries(type)) {
    const Field& field = *type.FindFieldByName(std::string(place.name));
    for (py::ssize_t i = 0; i < matrix.size(); ++i) {
      message.GetReflection()->AddDouble(&message, &field, matrix.data()[i]);
    }
    return true;
  }
  for (const char* const name : {"w_tt_per_kg", "w_tn_per_kg", "w_nn_per_kg"}) {
    if (beside.contains(name))
      Refuse({.outer = place.outer, .name = name}, "is set together with w_per_kg: must not be");
  }
  for (const Violation& violation : ViolationsOf(PackW(matrix, message))) {
    Refuse({.outer = place.outer, .name = violation.field}, violation.description);
  }
  return true;
}

absl::string_view ArgumentOf(absl::string_view field) {
  for (const auto& [python, name] : kFields) {
    if (field == name) return python;
  }
  return field;
}

void Filler::FillArgument(absl::string_view argument, py::handle value, Message& message) {
  if (IsNothing(value.ptr())) return;
  const FieldDescriptor& field = FieldOf(message, argument);
  if (field.has_presence() || !IsZeroOrFalse(value.ptr())) FillField(value, message, field, {.name = argument});
}

void Filler::FillField(py::handle value, Message& message, const Field& field, const Place& place) {
  const Reflection& reflection = *message.GetReflection();
  if (const auto* const choice = field.real_containing_oneof(); choice != nullptr) {
    const Field* const already = reflection.GetOneofFieldDescriptor(message, choice);
    if (already != nullptr && already != &field) {
      Refuse(place, absl::StrCat("is set together with ", already->name(), ": must not be"));
      return;
    }
  }
  if (field.is_repeated()) {
    FillList(value, message, field, place);
  } else if (field.cpp_type() == Field::CPPTYPE_MESSAGE) {
    Fill(value, *reflection.MutableMessage(&message, &field), &place);
  } else {
    Put(value, message, field, place);
  }
}

void Filler::FillList(py::handle value, Message& message, const Field& field, const Place& place) {
  const Reflection& reflection = *message.GetReflection();
  // A subclass is asked for its entries, as some may be masked.
  if (field.cpp_type() == Field::CPPTYPE_DOUBLE && py::isinstance<py::array_t<double>>(value) &&
      py::type::handle_of(value).is(PythonName("numpy", "ndarray"))) {
    const auto array = py::reinterpret_borrow<py::array_t<double>>(value);
    if (array.ndim() == 1) {
      const auto numbers = array.unchecked<1>();
      for (py::ssize_t i = 0; i < numbers.shape(0); ++i) reflection.AddDouble(&message, &field, numbers(i));
      return;
    }
  }
  auto entries = py::reinterpret_borrow<py::object>(value);
  if (field.cpp_type() == Field::CPPTYPE_ENUM || field.cpp_type() == Field::CPPTYPE_STRING) {
    entries = Ask("names", value, place.Text());
  } else if (!PyList_CheckExact(value.ptr()) && !PyTuple_CheckExact(value.ptr())) {
    entries = Ask("entries", value);
  }
  if (!entries) return;
  // Python handles its signals after so many entries, which take some milliseconds.
  constexpr int kEntries = 1024;
  int index = 0;
  for (const py::handle entry : entries) {
    if (index % kEntries == kEntries - 1 && PyErr_CheckSignals() != 0) throw py::error_already_set();
    const Place there = {.outer = place.outer, .name = place.name, .index = index++};
    if (field.cpp_type() == Field::CPPTYPE_MESSAGE) {
      Fill(entry, *reflection.AddMessage(&message, &field), &there);
    } else {
      // The error for an unknown name of an enum shows the name, so that its path needs no index.
      Put(entry, message, field, field.cpp_type() == Field::CPPTYPE_ENUM ? place : there);
    }
  }
}

std::optional<double> Filler::Number(py::handle value, const Place& place) {
  if (PyFloat_Check(value.ptr())) return PyFloat_AS_DOUBLE(value.ptr());
  if (PyLong_CheckExact(value.ptr())) {
    const double number = PyLong_AsDouble(value.ptr());
    if (PyErr_Occurred() == nullptr) return number;
    PyErr_Clear();
  }
  const py::object number = Ask("scalar", "double", value, place.Text());
  return number ? std::optional(number.cast<double>()) : std::nullopt;
}

std::optional<int> Filler::EnumNumber(py::handle value, const EnumDescriptor& type, const Place& place) {
  const auto name = Utf8(value.ptr());
  if (!name.has_value()) {
    Ask("scalar", "enum", value, place.Text());
    return std::nullopt;
  }
  const std::string upper = absl::AsciiStrToUpper(*name);
  for (const std::string& candidate : {upper, absl::StrCat(EnumPrefix(type), upper)}) {
    if (const auto* const found = type.FindValueByName(candidate); found != nullptr) return found->number();
  }
  py::list known;
  for (int i = 1; i < type.value_count(); ++i) {
    known.append(absl::AsciiStrToLower(type.value(i)->name().substr(EnumPrefix(type).size())));
  }
  Ask("unknown_name", place.Text(), value, known);
  return std::nullopt;
}

void Filler::Put(py::handle value, Message& message, const Field& field, const Place& place) {
  const Reflection& reflection = *message.GetReflection();
  const auto put = [&](auto set, auto add, auto found) {
    if (!found.has_value()) return;
    (reflection.*(field.is_repeated() ? add : set))(&message, &field, *std::move(found));
  };
  // Returns what Python makes of a value of the kind; nothing if it is none.
  const auto ask = [&]<typename Value>(const char* kind, Value /*type*/) -> std::optional<Value> {
    const py::object found = Ask("scalar", kind, value, place.Text());
    return found ? std::optional(found.cast<Value>()) : std::nullopt;
  };
  switch (field.cpp_type()) {
    case Field::CPPTYPE_DOUBLE:
      return put(&Reflection::SetDouble, &Reflection::AddDouble, Number(value, place));
    case Field::CPPTYPE_INT32:
      return put(&Reflection::SetInt32, &Reflection::AddInt32, ask("int32", int32_t{}));
    case Field::CPPTYPE_INT64:
      return put(&Reflection::SetInt64, &Reflection::AddInt64, ask("int64", int64_t{}));
    case Field::CPPTYPE_BOOL:
      return put(&Reflection::SetBool, &Reflection::AddBool, ask("bool", bool{}));
    case Field::CPPTYPE_STRING:
      return put(&Reflection::SetString, &Reflection::AddString, ask("text", std::string()));
    case Field::CPPTYPE_ENUM:
      return put(&Reflection::SetEnumValue, &Reflection::AddEnumValue, EnumNumber(value, *field.enum_type(), place));
    case Field::CPPTYPE_FLOAT:
    case Field::CPPTYPE_UINT32:
    case Field::CPPTYPE_UINT64:
    case Field::CPPTYPE_MESSAGE:
      break;
  }
  CheckInvariant(false, "the service's messages have fields of these kinds only");
}

}  // namespace ricochet::python
