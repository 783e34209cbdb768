#include "python/module/record.h"

#include <optional>
#include <utility>
#include <vector>

#include "absl/container/flat_hash_map.h"
#include "core/base/invariant.h"
#include "proto/wire/outcome.h"
#include "python/module/exceptions.h"
#include "ricochet/v1/outcome.pb.h"

namespace ricochet::python {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::EnumDescriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;

// An outcome that is not read yet, or not as a whole.
struct Unread {
  std::unique_ptr<SolveResponse> response;
  std::optional<v1::Outcome> message;  // Made when the first entry is asked for.
};
constexpr char kUnread[] = "ricochet.Unread";

// A field of a message, and its name as Python has it.
struct Entry {
  const FieldDescriptor* field;
  PyObject* name;
  bool may_be_unset;
};

// The facts about a type of messages or an enum, made once and kept for ever: a text that Python has interned is
// found without being hashed.
template <typename Known, typename Type>
const std::vector<Known>& Kept(const Type& type, Known (*make)(const Type& type, int i), int count) {
  static auto* const kept = new absl::flat_hash_map<const Type*, std::unique_ptr<std::vector<Known>>>();
  std::unique_ptr<std::vector<Known>>& all = (*kept)[&type];
  if (all == nullptr) {
    all = std::make_unique<std::vector<Known>>();
    for (int i = 0; i < count; ++i) all->push_back(make(type, i));
  }
  return *all;
}

Entry MakeEntry(const Descriptor& type, int i) {
  const FieldDescriptor* const field = type.field(i);
  return {.field = field,
          .name = PyUnicode_InternFromString(field->name().c_str()),
          .may_be_unset = !field->is_repeated() && field->has_presence()};
}
const std::vector<Entry>& EntriesOf(const Descriptor& type) { return Kept(type, MakeEntry, type.field_count()); }

PyObject* MakeName(const EnumDescriptor& type, int i) {
  return PyUnicode_InternFromString(type.value(i)->name().substr(EnumPrefix(type).size()).c_str());
}
const std::vector<PyObject*>& NamesOf(const EnumDescriptor& type) { return Kept(type, MakeName, type.value_count()); }

// Returns the class of an answer that is read, or of one that is not. They are looked up once, but under no guard of a
// static variable: an import can let another thread run, which would wait for the guard and hold the lock of Python.
PyTypeObject* RecordType(bool is_read) {
  static PyObject* types[2] = {nullptr, nullptr};
  PyObject*& type = types[is_read ? 1 : 0];
  if (type == nullptr) type = PythonName("ricochet.record", is_read ? "Record" : "UnreadRecord").release().ptr();
  return reinterpret_cast<PyTypeObject*>(type);
}

py::object Owned(PyObject* object) {
  if (object == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::object>(object);
}

void Put(PyObject* dictionary, PyObject* name, const py::object& value) {
  if (PyDict_SetItem(dictionary, name, value.ptr()) != 0) throw py::error_already_set();
}

// Makes an empty dictionary of a class without asking its constructor.
py::object Make(PyTypeObject* type) {
  static PyObject* const nothing = PyTuple_New(0);
  return Owned(type->tp_new(type, nothing, nullptr));
}

// Returns what a message in a message becomes.
using Convert = py::object (*)(const Message& message);

// The value of a field, or of its entry with this index.
py::object ValueOf(const Message& message, const FieldDescriptor& field, int index, Convert convert) {
  const Reflection& reflection = *message.GetReflection();
  const bool is_entry = index >= 0;
  const auto get = [&](auto of_field, auto of_entry) {
    return is_entry ? (reflection.*of_entry)(message, &field, index) : (reflection.*of_field)(message, &field);
  };
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return Owned(PyFloat_FromDouble(get(&Reflection::GetDouble, &Reflection::GetRepeatedDouble)));
    case FieldDescriptor::CPPTYPE_INT32:
      return Owned(PyLong_FromLong(get(&Reflection::GetInt32, &Reflection::GetRepeatedInt32)));
    case FieldDescriptor::CPPTYPE_INT64:
      return Owned(PyLong_FromLongLong(get(&Reflection::GetInt64, &Reflection::GetRepeatedInt64)));
    case FieldDescriptor::CPPTYPE_BOOL:
      return py::bool_(get(&Reflection::GetBool, &Reflection::GetRepeatedBool));
    case FieldDescriptor::CPPTYPE_ENUM:
      return EnumName(*field.enum_type(), get(&Reflection::GetEnumValue, &Reflection::GetRepeatedEnumValue));
    case FieldDescriptor::CPPTYPE_STRING:
      return Text(get(&Reflection::GetString, &Reflection::GetRepeatedString));
    case FieldDescriptor::CPPTYPE_MESSAGE:
      return convert(is_entry ? reflection.GetRepeatedMessage(message, &field, index)
                              : reflection.GetMessage(message, &field, nullptr));
    case FieldDescriptor::CPPTYPE_FLOAT:
    case FieldDescriptor::CPPTYPE_UINT32:
    case FieldDescriptor::CPPTYPE_UINT64:
      break;
  }
  CheckInvariant(false, "the service's messages have fields of these kinds only");
  return {};
}

py::object AllOf(const Message& message, const FieldDescriptor& field, Convert convert) {
  if (!field.is_repeated()) return ValueOf(message, field, -1, convert);
  const int size = message.GetReflection()->FieldSize(message, &field);
  py::object list = Owned(PyList_New(size));
  for (int i = 0; i < size; ++i) PyList_SET_ITEM(list.ptr(), i, ValueOf(message, field, i, convert).release().ptr());
  return list;
}

py::object EntryOf(const Message& message, const Entry& entry) {
  const bool is_unset = entry.may_be_unset && !message.GetReflection()->HasField(message, entry.field);
  return is_unset ? py::none() : AllOf(message, *entry.field, RecordOf);
}

const v1::Outcome& MessageOf(py::handle record) {
  auto* const unread = static_cast<Unread*>(PyCapsule_GetPointer(py::object(record.attr("_unread")).ptr(), kUnread));
  if (!unread->message.has_value()) unread->message = ToProto(unread->response->outcome);
  return *unread->message;
}

bool IsRead(py::handle record) { return Py_TYPE(record.ptr()) == RecordType(/*is_read=*/true); }

}  // namespace

py::object EnumName(const EnumDescriptor& type, int number) {
  return py::reinterpret_borrow<py::object>(NamesOf(type).at(static_cast<size_t>(number)));
}

py::list EnumNames(const EnumDescriptor& type) {
  py::list names;
  for (PyObject* name : NamesOf(type)) names.append(py::handle(name));
  return names;
}

py::list FieldNames(const Descriptor& type) {
  py::list names;
  for (const Entry& entry : EntriesOf(type)) names.append(py::handle(entry.name));
  return names;
}

py::object RecordOf(const Message& message) {
  py::object record = Make(RecordType(/*is_read=*/true));
  for (const Entry& entry : EntriesOf(*message.GetDescriptor())) {
    Put(record.ptr(), entry.name, EntryOf(message, entry));
  }
  return record;
}

py::dict DictionaryOf(const Message& message) {
  std::vector<const FieldDescriptor*> fields;
  message.GetReflection()->ListFields(message, &fields);
  py::dict dictionary;
  const Convert convert = [](const Message& part) -> py::object { return DictionaryOf(part); };
  for (const FieldDescriptor* field : fields) dictionary[field->name().c_str()] = AllOf(message, *field, convert);
  return dictionary;
}

py::object UnreadRecordOf(std::unique_ptr<SolveResponse> response) {
  py::object record = Make(RecordType(/*is_read=*/false));
  // The first entry is there from the start: C code that asks a dictionary for its size does not ask Python.
  static const Entry& first = EntriesOf(*v1::Outcome::descriptor()).front();
  const int regime = ToProto(response->outcome.regime);
  Put(record.ptr(), first.name, EnumName(*v1::Regime_descriptor(), regime));
  auto unread = std::make_unique<Unread>(Unread{.response = std::move(response)});
  const auto drop = [](PyObject* capsule) { delete static_cast<Unread*>(PyCapsule_GetPointer(capsule, kUnread)); };
  const py::object capsule = Owned(PyCapsule_New(unread.get(), kUnread, drop));
  unread.release();  // NOLINT(bugprone-unused-return-value): the capsule owns it.
  static PyObject* const slot = PyUnicode_InternFromString("_unread");
  if (PyObject_GenericSetAttr(record.ptr(), slot, capsule.ptr()) != 0) throw py::error_already_set();
  return record;
}

py::object ReadEntry(py::handle record, py::handle name) {
  if (PyObject* const known = PyDict_GetItemWithError(record.ptr(), name.ptr()); known != nullptr) {
    return py::reinterpret_borrow<py::object>(known);
  }
  // Another thread may have read the whole record while this one asked for the entry.
  if (IsRead(record)) return {};
  for (const Entry& entry : EntriesOf(*v1::Outcome::descriptor())) {
    if (PyObject_RichCompareBool(entry.name, name.ptr(), Py_EQ) != 1) continue;
    py::object value = EntryOf(MessageOf(record), entry);
    Put(record.ptr(), entry.name, value);
    return value;
  }
  return {};
}

void ReadRecord(py::handle record) {
  if (IsRead(record)) return;
  // A value that was read before stays the same object, and the order is that of the message.
  std::vector<py::object> values;
  const std::vector<Entry>& entries = EntriesOf(*v1::Outcome::descriptor());
  for (const Entry& entry : entries) values.push_back(ReadEntry(record, entry.name));
  PyDict_Clear(record.ptr());
  for (size_t i = 0; i < entries.size(); ++i) Put(record.ptr(), entries[i].name, values[i]);
  record.attr("_unread") = py::none();
  record.attr("__class__") = py::handle(reinterpret_cast<PyObject*>(RecordType(/*is_read=*/true)));
}

}  // namespace ricochet::python
