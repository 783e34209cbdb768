#include "python/module/exceptions.h"

#include <string>

#include "python/module/filler.h"
#include "python/module/record.h"
#include "ricochet/v1/error_reason.pb.h"

namespace ricochet::python {
namespace {

py::list ListOf(const std::vector<Violation>& violations) {
  const py::object make = PythonName("ricochet.errors", "Violation");
  py::list list;
  for (const Violation& violation : violations) list.append(make(violation.field, violation.description));
  return list;
}

[[noreturn]] void Raise(const py::object& exception) {
  PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(exception.ptr())), exception.ptr());
  throw py::error_already_set();
}

}  // namespace

void Raise(const absl::Status& error) {
  std::vector<Violation> violations = ViolationsOf(error);
  if (error.code() == absl::StatusCode::kInvalidArgument && !violations.empty()) {
    for (Violation& violation : violations) {
      const std::string field = violation.field.substr(0, violation.field.find('['));
      violation.field.replace(0, field.size(), std::string(ArgumentOf(field)));
    }
    Raise(violations);
  }
  const ErrorReason reason = ReasonOf(error);
  const bool has_reason = reason != ErrorReason::kUnspecified;
  const auto delay = RetryDelayOf(error);
  const py::object none = py::none();
  Raise(PythonName("ricochet.errors", "from_status")(
      absl::StatusCodeToString(error.code()), Text(error.message()),
      has_reason ? EnumName(*v1::ErrorReason_descriptor(), static_cast<int>(reason)) : py::str(), ListOf(violations),
      delay.has_value() ? py::float_(static_cast<double>(delay->count()) * 1e-3) : none));
}

void Raise(const std::vector<Violation>& violations) {
  Raise(PythonName("ricochet.errors", "InvalidRequest").attr("of")(ListOf(violations)));
}

}  // namespace ricochet::python
