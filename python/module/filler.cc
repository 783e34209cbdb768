#include "python/module/filler.h"

#include <google/protobuf/descriptor.h>
#include <pybind11/numpy.h>

#include <cstdint>
#include <limits>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "core/base/invariant.h"
#include "python/module/enum_names.h"
#include "python/module/python_names.h"

namespace ricochet::python {
namespace {

using google::protobuf::EnumDescriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Reflection;

// The arguments of Python whose field is called otherwise.
constexpr std::pair<const char*, const char*> kFields[] = {{"tolerance", "relative_tolerance"},
                                                           {"require", "required"},
                                                           {"exclude", "excluded"},
                                                           {"strict", "inadmissible_is_error"},
                                                           {"history", "history_intervals"},
                                                           {"force_history", "force_intervals"},
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

// The text of a str; nothing if it is none, or none that can be encoded.
std::optional<absl::string_view> Utf8(PyObject* value) {
  if (!PyUnicode_Check(value)) return std::nullopt;
  Py_ssize_t size = 0;
  const char* const text = PyUnicode_AsUTF8AndSize(value, &size);
  if (text != nullptr) return absl::string_view(text, static_cast<size_t>(size));
  PyErr_Clear();
  return std::nullopt;
}

py::list NamesOf(const google::protobuf::Descriptor& type) {
  py::list names;
  for (int i = 0; i < type.field_count(); ++i) names.append(type.field(i)->name());
  return names;
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

// The name of W, and of its six entries in space.
constexpr char kMatrix[] = "w_per_kg";

// Returns whether `value` is a list of six numbers.
bool HasSixNumbers(PyObject* value) {
  if (!PyList_CheckExact(value) || PyList_GET_SIZE(value) != 6) return false;
  return PyNumber_Check(PyList_GET_ITEM(value, 0)) != 0;
}

}  // namespace

std::string Place::Text() const {
  std::string text = outer == nullptr ? "" : absl::StrCat(outer->Text(), ".");
  absl::StrAppend(&text, name);
  if (index >= 0) absl::StrAppend(&text, "[", index, "]");
  return text;
}

template <typename... Arguments>
py::object Filler::AskModule(const char* module, const char* name, Arguments&&... arguments) {
  try {
    return PythonName(module, name)(std::forward<Arguments>(arguments)...);
  } catch (const py::error_already_set& error) {
    if (!error.matches(PythonName("ricochet.errors", "InvalidRequest"))) throw;
    for (const py::handle violation : error.value().attr("violations")) {
      Refuse(py::str(violation.attr("field")), py::str(violation.attr("description")));
    }
    return {};
  }
}

void Filler::Fill(py::handle values, Message& message, const Place* place) {
  py::dict dictionary;
  if (!ReadDictionary(values, dictionary)) {
    Ask("dictionary_expected", values, place == nullptr ? "scene" : place->Text());
    return;
  }
  const google::protobuf::Descriptor& type = *message.GetDescriptor();
  if (PyObject* const matrix = PyDict_GetItemString(dictionary.ptr(), kMatrix); matrix != nullptr) {
    dictionary = WithoutMatrix(dictionary, matrix, message, place);
  }
  PyObject* key = nullptr;
  PyObject* value = nullptr;
  for (Py_ssize_t position = 0; PyDict_Next(dictionary.ptr(), &position, &key, &value) != 0;) {
    // What a value is asked for may run Python, which may change the dictionary.
    const py::object held_key = py::reinterpret_borrow<py::object>(key);
    const py::object held_value = py::reinterpret_borrow<py::object>(value);
    const auto name = Utf8(key);
    const FieldDescriptor* const field = name.has_value() ? type.FindFieldByName(std::string(*name)) : nullptr;
    if (field == nullptr) {
      const std::string shown = py::str(held_key);
      const Place there = {.outer = place, .name = shown};
      Ask("unknown_field", there.Text(), held_key, NamesOf(type));
    } else if (value != Py_None) {
      FillField(held_value, message, *field, {.outer = place, .name = *name});
    }
  }
}

py::dict Filler::WithoutMatrix(const py::dict& dictionary, py::handle matrix, const Message& message,
                               const Place* place) {
  const google::protobuf::Descriptor& type = *message.GetDescriptor();
  if (type.FindFieldByName(kMatrix) != nullptr && HasSixNumbers(matrix.ptr())) return dictionary;
  const std::string path = place == nullptr ? "" : place->Text();
  py::object unpacked = AskModule("ricochet.contact_matrix", "unpacked", type.name(), dictionary, path);
  if (unpacked) return unpacked;
  py::dict rest = dictionary.attr("copy")();
  PyDict_DelItemString(rest.ptr(), kMatrix);
  return rest;
}

void Filler::FillArgument(absl::string_view argument, py::handle value, Message& message) {
  if (IsNothing(value.ptr())) return;
  const FieldDescriptor& field = FieldOf(message, argument);
  if (field.has_presence() || !IsZeroOrFalse(value.ptr())) FillField(value, message, field, {.name = argument});
}

void Filler::Finish() const {
  if (violations_.empty()) return;
  const py::object make = PythonName("ricochet.errors", "Violation");
  py::list violations;
  for (const auto& [place, description] : violations_) violations.append(make(place, description));
  const py::object error = PythonName("ricochet.errors", "InvalidRequest").attr("of")(violations);
  PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(error.ptr())), error.ptr());
  throw py::error_already_set();
}

void Filler::FillField(py::handle value, Message& message, const Field& field, const Place& place) {
  const Reflection& reflection = *message.GetReflection();
  if (const auto* const choice = field.real_containing_oneof(); choice != nullptr) {
    const Field* const already = reflection.GetOneofFieldDescriptor(message, choice);
    if (already != nullptr && already != &field) {
      Refuse(place.Text(), absl::StrCat("is set together with ", already->name(), ": must not be"));
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
  if (field.cpp_type() == Field::CPPTYPE_DOUBLE && py::isinstance<py::array_t<double>>(value)) {
    const auto array = py::reinterpret_borrow<py::array_t<double>>(value);
    if (array.ndim() == 1) {
      const auto numbers = array.unchecked<1>();
      for (py::ssize_t i = 0; i < numbers.shape(0); ++i) reflection.AddDouble(&message, &field, numbers(i));
      return;
    }
  }
  py::object entries = py::reinterpret_borrow<py::object>(value);
  if (field.cpp_type() == Field::CPPTYPE_ENUM || field.cpp_type() == Field::CPPTYPE_STRING) {
    entries = Ask("names", value, place.Text());
  } else if (!PyList_CheckExact(value.ptr()) && !PyTuple_CheckExact(value.ptr())) {
    entries = Ask("entries", value);
  }
  if (!entries) return;
  int index = 0;
  for (const py::handle entry : entries) {
    const Place there = {.outer = place.outer, .name = place.name, .index = index++};
    if (field.cpp_type() == Field::CPPTYPE_MESSAGE) {
      Fill(entry, *reflection.AddMessage(&message, &field), &there);
    } else {
      // A name that is unknown is shown, and needs no index.
      Put(entry, message, field, field.cpp_type() == Field::CPPTYPE_ENUM ? place : there);
    }
  }
}

py::object Filler::Scalar(const char* kind, py::handle value, const Place& place) {
  return Ask("scalar", kind, value, place.Text());
}

std::optional<double> Filler::Number(py::handle value, const Place& place) {
  if (PyFloat_Check(value.ptr())) return PyFloat_AS_DOUBLE(value.ptr());
  if (PyLong_CheckExact(value.ptr())) {
    const double number = PyLong_AsDouble(value.ptr());
    if (PyErr_Occurred() == nullptr) return number;
    PyErr_Clear();
  }
  const py::object number = Scalar("double", value, place);
  return number ? std::optional(number.cast<double>()) : std::nullopt;
}

std::optional<int> Filler::EnumNumber(py::handle value, const EnumDescriptor& type, const Place& place) {
  const auto name = Utf8(value.ptr());
  if (!name.has_value()) {
    Scalar("enum", value, place);
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
    if (field.is_repeated()) {
      (reflection.*add)(&message, &field, std::move(found));
    } else {
      (reflection.*set)(&message, &field, std::move(found));
    }
  };
  const auto whole = [&](const char* kind) -> std::optional<int64_t> {
    const py::object number = Scalar(kind, value, place);
    return number ? std::optional(number.cast<int64_t>()) : std::nullopt;
  };
  switch (field.cpp_type()) {
    case Field::CPPTYPE_DOUBLE:
      if (const auto number = Number(value, place); number.has_value()) {
        put(&Reflection::SetDouble, &Reflection::AddDouble, *number);
      }
      return;
    case Field::CPPTYPE_INT32:
      if (const auto number = whole("int32"); number.has_value()) {
        put(&Reflection::SetInt32, &Reflection::AddInt32, static_cast<int32_t>(*number));
      }
      return;
    case Field::CPPTYPE_INT64:
      if (const auto number = whole("int64"); number.has_value()) {
        put(&Reflection::SetInt64, &Reflection::AddInt64, *number);
      }
      return;
    case Field::CPPTYPE_BOOL:
      if (const py::object found = Scalar("bool", value, place); found) {
        put(&Reflection::SetBool, &Reflection::AddBool, found.cast<bool>());
      }
      return;
    case Field::CPPTYPE_STRING:
      if (const py::object found = Scalar("text", value, place); found) {
        put(&Reflection::SetString, &Reflection::AddString, found.cast<std::string>());
      }
      return;
    case Field::CPPTYPE_ENUM:
      if (const auto number = EnumNumber(value, *field.enum_type(), place); number.has_value()) {
        put(&Reflection::SetEnumValue, &Reflection::AddEnumValue, *number);
      }
      return;
    case Field::CPPTYPE_FLOAT:
    case Field::CPPTYPE_UINT32:
    case Field::CPPTYPE_UINT64:
    case Field::CPPTYPE_MESSAGE:
      break;
  }
  CheckInvariant(false, "the service's messages have fields of these kinds only");
}

}  // namespace ricochet::python
