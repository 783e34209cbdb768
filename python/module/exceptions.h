// Exceptions: what Python raises for an error of a call, and what Python is asked for by name.
//
// ricochet/errors.py has the classes. Every function needs the lock of Python and throws what Python raises.

#ifndef RICOCHET_PYTHON_MODULE_EXCEPTIONS_H_
#define RICOCHET_PYTHON_MODULE_EXCEPTIONS_H_

#include <pybind11/pybind11.h>

#include <vector>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "ricochet/error.h"

namespace ricochet::python {

namespace py = pybind11;

// Returns a name of a module of Python, such as ricochet.values.number.
inline py::object PythonName(const char* module, const char* name) { return py::module_::import(module).attr(name); }

inline py::str Text(absl::string_view text) { return {text.data(), text.size()}; }

// Raises the exception for an error, with its reason, its violations and the time after which to try again.
[[noreturn]] void Raise(const absl::Status& error);

// Raises InvalidRequest with all of these violations, of which a status would list only the first ones.
[[noreturn]] void Raise(const std::vector<Violation>& violations);

}  // namespace ricochet::python

#endif  // RICOCHET_PYTHON_MODULE_EXCEPTIONS_H_
