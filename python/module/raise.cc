#include "python/module/raise.h"

#include <string>

#include "core/base/invariant.h"
#include "proto/wire/enums.h"
#include "python/module/enum_names.h"
#include "python/module/python_names.h"
#include "ricochet/error.h"
#include "ricochet/v1/error_reason.pb.h"

namespace ricochet::python {

void Raise(const absl::Status& error) {
  CheckInvariant(!error.ok(), "what is raised is an error");
  py::list violations;
  for (const Violation& violation : ViolationsOf(error)) {
    violations.append(py::make_tuple(violation.field, violation.description));
  }
  py::object retry_after_s = py::none();
  if (const auto delay = RetryDelayOf(error); delay.has_value()) {
    retry_after_s = py::float_(static_cast<double>(delay->count()) * 1e-3);
  }
  const ErrorReason reason = ReasonOf(error);
  const py::object name = reason == ErrorReason::kUnspecified
                              ? py::str()
                              : EnumName(*v1::ErrorReason_descriptor(), static_cast<int>(reason));
  const py::object exception = PythonName("ricochet.errors", "from_status")(
      absl::StatusCodeToString(error.code()), Text(error.message()), name, violations, retry_after_s);
  PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(exception.ptr())), exception.ptr());
  throw py::error_already_set();
}

}  // namespace ricochet::python
