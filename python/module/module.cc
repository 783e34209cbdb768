// The module ricochet._core: the functions of the package, computed in this process or by a server that is named.

#include <google/protobuf/descriptor.h>
#include <pybind11/pybind11.h>

#include <string>

#include "absl/strings/str_cat.h"
#include "absl/synchronization/mutex.h"
#include "core/base/invariant.h"
#include "python/module/enum_names.h"
#include "python/module/fork.h"
#include "python/module/record.h"
#include "python/module/request.h"
#include "python/module/scene.h"
#include "python/module/solver.h"

namespace ricochet::python {
namespace {

namespace py = pybind11;
using google::protobuf::DescriptorPool;

py::list NamesOfEnum(const std::string& name) {
  const auto* const type = DescriptorPool::generated_pool()->FindEnumTypeByName(absl::StrCat("ricochet.v1.", name));
  CheckInvariant(type != nullptr, "Python asks for the names of an enum of the service");
  return EnumNames(*type);
}

py::list NamesOfFields(const std::string& name) {
  const auto* const type = DescriptorPool::generated_pool()->FindMessageTypeByName(absl::StrCat("ricochet.v1.", name));
  CheckInvariant(type != nullptr, "Python asks for the fields of a message of the service");
  py::list names;
  for (int i = 0; i < type->field_count(); ++i) names.append(type->field(i)->name());
  return names;
}

}  // namespace
}  // namespace ricochet::python

PYBIND11_MODULE(_core, module) {
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
  using namespace ricochet::python;  // NOLINT(google-build-using-namespace): the module is theirs.
  AddScene(module);
  AddRequest(module);
  AddSolver(module);
  AddForks(module);
  module.def("read", &ReadRecord);
  module.def("read_entry", [](py::handle record, py::handle name) {
    py::object entry = ReadEntry(record, name);
    if (!entry) throw py::key_error(py::str(name));
    return entry;
  });
  module.def("enum_names", &NamesOfEnum);
  module.def("field_names", &NamesOfFields);
}
