// Scenes as a caller of Python gives them: dictionaries, or PreparedScenes that were read from one before.

#ifndef RICOCHET_PYTHON_MODULE_SCENE_H_
#define RICOCHET_PYTHON_MODULE_SCENE_H_

#include <pybind11/pybind11.h>

#include "python/module/filler.h"
#include "ricochet/scene.h"

namespace ricochet::python {

// Returns the scene that `given` is or describes; `filler` keeps what is wrong with it.
Scene SceneOf(py::handle given, Filler& filler);

// Adds ricochet.Scene, the names of its numbers, and the reader of files to the module.
void AddScene(py::module_& module);

}  // namespace ricochet::python

#endif  // RICOCHET_PYTHON_MODULE_SCENE_H_
