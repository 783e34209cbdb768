// Scenes as a caller of Python gives them: dictionaries, or PreparedScenes that were read from one before.

#ifndef RICOCHET_PYTHON_MODULE_SCENE_H_
#define RICOCHET_PYTHON_MODULE_SCENE_H_

#include <pybind11/pybind11.h>

#include <string>

#include "python/module/filler.h"
#include "ricochet/scene.h"

namespace ricochet::python {

// ricochet.Scene: a scene that was read once, for calls that need not read it again.
struct PreparedScene {
  Scene scene;
};

// Returns the scene that `given` is or describes; `filler` keeps what is wrong with it.
Scene SceneOf(pybind11::handle given, Filler& filler);

// Returns the scene in a text as a dictionary with what the text sets. Raises ValueError that says why it is none.
pybind11::dict ParseScene(const std::string& text, bool is_json);

// Adds ricochet.Scene and the function above to the module.
void AddScene(pybind11::module_& module);

}  // namespace ricochet::python

#endif  // RICOCHET_PYTHON_MODULE_SCENE_H_
