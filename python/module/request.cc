#include "python/module/request.h"

#include <google/protobuf/descriptor.h>
#include <pybind11/stl.h>

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "core/rows/column.h"
#include "core/scene/field.h"
#include "python/module/filler.h"
#include "python/module/scene.h"

namespace ricochet::python {
namespace {

namespace py = pybind11;
using google::protobuf::DescriptorPool;
using google::protobuf::MessageFactory;

std::unique_ptr<google::protobuf::Message> NewMessage(const std::string& type) {
  const auto* const found = DescriptorPool::generated_pool()->FindMessageTypeByName(absl::StrCat("ricochet.v1.", type));
  CheckInvariant(found != nullptr, "a function of Python makes a request of the service");
  return std::unique_ptr<google::protobuf::Message>(MessageFactory::generated_factory()->GetPrototype(found)->New());
}

}  // namespace

Request::Request(const std::string& type, py::handle scene, const py::dict& arguments) : message_(NewMessage(type)) {
  Filler filler;
  scene_ = SceneOf(scene, filler);
  for (const auto& [name, value] : arguments) filler.FillArgument(name.cast<std::string>(), value, *message_);
  filler.Finish();
}

void Request::Set(const py::dict& fields) {
  Filler filler;
  filler.Fill(fields, *message_);
  filler.Finish();
}

Paths Request::Fields() const { return {FieldPaths(scene_)}; }
Paths Request::Columns() const { return {ColumnPlaces(scene_)}; }

void AddRequest(py::module_& module) {
  py::class_<Paths>(module, "Paths")
      .def("__contains__",
           [](const Paths& paths, const std::string& text) {
             return std::find(paths.texts.begin(), paths.texts.end(), text) != paths.texts.end();
           })
      .def("__len__", [](const Paths& paths) { return paths.texts.size(); })
      .def("__iter__", [](const Paths& paths) { return py::iter(py::cast(paths.texts)); });
  py::class_<Request>(module, "Request")
      .def(py::init<const std::string&, py::handle, const py::dict&>())
      .def("set", &Request::Set)
      .def("fields", &Request::Fields)
      .def("columns", &Request::Columns);
}

}  // namespace ricochet::python
