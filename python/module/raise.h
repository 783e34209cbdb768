// Raise: the exception of Python for the error of a call. ricochet/errors.py has the classes.

#ifndef RICOCHET_PYTHON_MODULE_RAISE_H_
#define RICOCHET_PYTHON_MODULE_RAISE_H_

#include "absl/status/status.h"

namespace ricochet::python {

// Raises the exception for an error, with its reason, its violations and the time after which to try again.
[[noreturn]] void Raise(const absl::Status& error);

}  // namespace ricochet::python

#endif  // RICOCHET_PYTHON_MODULE_RAISE_H_
