#include "python/module/scene.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include "core/rows/column.h"
#include "core/scene/field.h"
#include "core/scene/system_velocities.h"
#include "proto/text/message_text.h"
#include "proto/wire/scene.h"
#include "python/module/record.h"

namespace ricochet::python {
namespace {

// ricochet.Scene: a scene that was read once, for calls that need not read it again.
struct PreparedScene {
  Scene scene;
};

// The names that a caller may give, as a collection of Python that is searched without being copied.
struct Paths {
  std::vector<std::string> texts;

  bool Contains(const std::string& text) const { return std::find(texts.begin(), texts.end(), text) != texts.end(); }
};

// Returns the scene in the text of a file, which may have several contacts, as a dictionary with what it sets. Raises
// ValueError that says why not.
py::dict ParseScene(const std::string& path, const std::string& text) {
  AnyScene scene;
  if (const std::string wrong = WhyNoScene(path, text, scene); !wrong.empty()) throw py::value_error(wrong);
  return std::visit([](const auto& its_scene) { return DictionaryOf(its_scene); }, scene);
}

constexpr char kSceneHelp[] =
    R"(A scene that is read once, for many calls. Every function that takes a scene takes it, too.

Args:
    scene: the impact, a dictionary with the names of ricochet.v1.Scene; units are SI and radians.

Raises:
    InvalidRequest: a name is unknown, or a value is of a wrong kind. The rules of the numbers are checked by each
        call.)";

py::dict ToDict(const PreparedScene& prepared) { return DictionaryOf(ToProto(prepared.scene)); }

}  // namespace

Scene SceneOf(py::handle given, Filler& filler) {
  if (py::isinstance<PreparedScene>(given)) return py::cast<const PreparedScene&>(given).scene;
  v1::Scene scene;
  filler.Fill(given, scene);
  return FromProto(scene);
}

void AddScene(py::module_& module) {
  const auto read = [](py::handle given) {
    Filler filler;
    PreparedScene prepared{SceneOf(given, filler)};
    filler.Finish();
    return prepared;
  };
  py::class_<Paths>(module, "Paths")
      .def("__contains__", &Paths::Contains)
      .def("__len__", [](const Paths& paths) { return paths.texts.size(); })
      .def("__iter__", [](const Paths& paths) { return py::iter(py::cast(paths.texts)); });
  py::class_<PreparedScene>(module, "Scene", kSceneHelp)
      .def(py::init(read), py::arg("scene"))
      .def("to_dict", &ToDict, "Returns the scene as a dictionary.")
      .def("_fields", [](const PreparedScene& self) { return Paths{AllFieldPaths(self.scene)}; })
      .def("_velocities", [](const PreparedScene& self) { return SystemVelocityPaths(self.scene.system); })
      .def("_columns", [](const PreparedScene& self) { return Paths{ColumnPlaces(self.scene)}; })
      .def("__repr__", [](const PreparedScene& self) { return py::str("Scene({!r})").format(ToDict(self)); })
      .def(
          "__eq__", [](const PreparedScene& a, const PreparedScene& b) { return a.scene == b.scene; },
          py::is_operator())
      .def("__reduce__", [](py::handle self) {
        return py::make_tuple(self.attr("__class__"), py::make_tuple(ToDict(self.cast<const PreparedScene&>())));
      });
  module.def("parse_scene", &ParseScene);
}

}  // namespace ricochet::python
