#include "python/module/scene.h"

#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/text_format.h>
#include <google/protobuf/util/json_util.h>

#include "absl/strings/str_cat.h"
#include "proto/wire/scene.h"
#include "python/module/python_names.h"
#include "python/module/record.h"

namespace ricochet::python {
namespace {

class FirstError final : public google::protobuf::io::ErrorCollector {
 public:
  void AddError(int line, google::protobuf::io::ColumnNumber column, const std::string& message) override {
    if (text.empty()) text = absl::StrCat("line ", line + 1, ", column ", column + 1, ": ", message);
  }
  std::string text;
};

constexpr char kSceneHelp[] =
    R"(A scene that is read once, for many calls. Every function that takes a scene takes it, too.

Args:
    scene: the impact, a dictionary with the names of ricochet.v1.Scene; units are SI and radians.

Raises:
    InvalidRequest: a name is unknown, or a value is of a wrong kind. The rules of the numbers are checked by each call.)";

}  // namespace

Scene SceneOf(py::handle given, Filler& filler) {
  if (py::isinstance<PreparedScene>(given)) return py::cast<const PreparedScene&>(given).scene;
  v1::Scene scene;
  filler.Fill(given, scene);
  return FromProto(scene);
}

py::dict ParseScene(const std::string& text, bool is_json) {
  v1::Scene scene;
  FirstError error;
  if (is_json) {
    const auto status = google::protobuf::util::JsonStringToMessage(text, &scene);
    if (!status.ok()) error.text = std::string(status.message());
  } else {
    google::protobuf::TextFormat::Parser parser;
    parser.RecordErrorsTo(&error);
    parser.ParseFromString(text, &scene);
  }
  if (!error.text.empty()) throw py::value_error(error.text);
  return DictionaryOf(scene);
}

void AddScene(py::module_& module) {
  const auto read = [](py::handle given) {
    Filler filler;
    PreparedScene prepared{SceneOf(given, filler)};
    filler.Finish();
    return prepared;
  };
  const auto to_dict = [](const PreparedScene& prepared) { return DictionaryOf(ToProto(prepared.scene)); };
  const auto repr = [to_dict](const PreparedScene& prepared) {
    return py::str("Scene({!r})").format(to_dict(prepared));
  };
  py::class_<PreparedScene>(module, "Scene", kSceneHelp)
      .def(py::init(read), py::arg("scene"))
      .def("to_dict", to_dict, "Returns the scene as a dictionary.")
      .def("__repr__", repr)
      .def("__eq__", [](const PreparedScene& a, const PreparedScene& b) { return a.scene == b.scene; },
           py::is_operator())
      .def("__reduce__", [to_dict](py::handle self) {
        return py::make_tuple(self.attr("__class__"), py::make_tuple(to_dict(self.cast<const PreparedScene&>())));
      });
  module.def("parse_scene", &ParseScene, py::arg("text"), py::arg("is_json"));
}

}  // namespace ricochet::python
