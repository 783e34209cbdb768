// BoundSolver: the Solver that a Client of Python asks: one in this process, or one that asks a server.

#ifndef RICOCHET_PYTHON_MODULE_SOLVER_H_
#define RICOCHET_PYTHON_MODULE_SOLVER_H_

#include <pybind11/pybind11.h>

#include <utility>

#include "python/module/call.h"
#include "python/module/request.h"

namespace ricochet::python {

class BoundSolver {
 public:
  explicit BoundSolver(Callee callee) : callee_(std::move(callee)) {}

  const Callee& callee() const { return callee_; }

  // Leaves the solver as it is for ever: after a fork its threads and connections are those of the parent.
  void Abandon();

 private:
  Callee callee_;
};

// Adds the class to the module, with every call but those of rows.
void AddSolver(pybind11::module_& module);

// Adds sweeps and batches to it, and the values of axes to the module.
void AddRows(pybind11::module_& module, pybind11::class_<BoundSolver>& solver);

}  // namespace ricochet::python

#endif  // RICOCHET_PYTHON_MODULE_SOLVER_H_
