// Rows: sweeps and batches, whose columns are arrays of NumPy.

#ifndef RICOCHET_PYTHON_MODULE_ROWS_H_
#define RICOCHET_PYTHON_MODULE_ROWS_H_

#include <pybind11/pybind11.h>

#include "python/module/call.h"

namespace ricochet::python {

// Adds sweeps and batches to the class of solvers, and the values of axes to the module.
void AddRows(py::module_& module, py::class_<Callee>& solver);

// Adds the function reduce_states: many states of a mechanism, each as M, J in world axes and q', reduced to contacts
// in space for one batch.
void AddStates(py::module_& module);

}  // namespace ricochet::python

#endif  // RICOCHET_PYTHON_MODULE_ROWS_H_
