// States: many states of a mechanism, each as M, J in world axes and q', reduced to contacts in space for one batch.

#ifndef RICOCHET_PYTHON_MODULE_STATES_H_
#define RICOCHET_PYTHON_MODULE_STATES_H_

#include <pybind11/pybind11.h>

#include "python/module/exceptions.h"

namespace ricochet::python {

// Adds the function reduce_states to the module.
void AddStates(py::module_& module);

}  // namespace ricochet::python

#endif  // RICOCHET_PYTHON_MODULE_STATES_H_
