// What the module takes from the Python side of the package, which holds all that is not worth a line of C++: the
// classes of records and errors, and the helpers that say what is wrong with a value.
//
// Every function here needs the lock of Python and throws what Python raises.

#ifndef RICOCHET_PYTHON_MODULE_PYTHON_NAMES_H_
#define RICOCHET_PYTHON_MODULE_PYTHON_NAMES_H_

#include <pybind11/pybind11.h>

#include <string>

#include "absl/strings/string_view.h"

namespace ricochet::python {

namespace py = pybind11;

// Returns `name` of the package's module, such as ricochet.values.number.
inline py::object PythonName(const char* module, const char* name) { return py::module_::import(module).attr(name); }

// Returns the class of an answer that is read, and of one that is not. They are looked up once: no guard of a static
// variable may be held here, because an import can let another thread run that waits for the guard.
inline PyTypeObject* RecordType(bool is_read) {
  static PyObject* types[2] = {nullptr, nullptr};
  PyObject*& type = types[is_read ? 1 : 0];
  if (type == nullptr) type = PythonName("ricochet.record", is_read ? "Record" : "UnreadRecord").release().ptr();
  return reinterpret_cast<PyTypeObject*>(type);
}

inline py::str Text(absl::string_view text) { return {text.data(), text.size()}; }

}  // namespace ricochet::python

#endif  // RICOCHET_PYTHON_MODULE_PYTHON_NAMES_H_
