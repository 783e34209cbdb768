#include "python/module/enum_names.h"

#include <algorithm>
#include <memory>
#include <vector>

#include "absl/container/flat_hash_map.h"

namespace ricochet::python {
namespace {

namespace py = pybind11;
using google::protobuf::EnumDescriptor;

// The enums of the service have the numbers 0, 1, 2, ...
const std::vector<PyObject*>& NamesOf(const EnumDescriptor& type) {
  static auto* const known = new absl::flat_hash_map<const EnumDescriptor*, std::unique_ptr<std::vector<PyObject*>>>();
  std::unique_ptr<std::vector<PyObject*>>& names = (*known)[&type];
  if (names == nullptr) {
    names = std::make_unique<std::vector<PyObject*>>();
    const size_t prefix = EnumPrefix(type).size();
    for (int i = 0; i < type.value_count(); ++i) {
      names->push_back(PyUnicode_InternFromString(type.value(i)->name().substr(prefix).c_str()));
    }
  }
  return *names;
}

}  // namespace

std::string EnumPrefix(const EnumDescriptor& type) {
  std::string prefix = type.value(0)->name();
  for (int i = 1; i < type.value_count(); ++i) {
    const std::string& name = type.value(i)->name();
    const auto differ = std::mismatch(prefix.begin(), prefix.end(), name.begin(), name.end()).first;
    prefix.erase(differ, prefix.end());
  }
  return prefix.substr(0, prefix.rfind('_') + 1);
}

py::object EnumName(const EnumDescriptor& type, int number) {
  return py::reinterpret_borrow<py::object>(NamesOf(type).at(static_cast<size_t>(number)));
}

py::list EnumNames(const EnumDescriptor& type) {
  py::list names;
  for (PyObject* name : NamesOf(type)) names.append(py::handle(name));
  return names;
}

}  // namespace ricochet::python
