// RequestOf: the request of a call from what Python gives: the scene, and the arguments of a function by their names.

#ifndef RICOCHET_PYTHON_MODULE_REQUEST_H_
#define RICOCHET_PYTHON_MODULE_REQUEST_H_

#include <pybind11/pybind11.h>

#include <string>
#include <type_traits>

#include "proto/wire/audit.h"
#include "proto/wire/batch.h"
#include "proto/wire/cost.h"
#include "proto/wire/fit.h"
#include "proto/wire/multi_contact.h"
#include "proto/wire/requests.h"
#include "proto/wire/sweep.h"
#include "python/module/filler.h"
#include "python/module/scene.h"

namespace ricochet::python {

template <typename Request>
Scene& SceneIn(Request& request) {
  return request.scene;
}
inline Scene& SceneIn(SweepRequest& request) { return request.grid.scene; }

// `Wire` is the message of the request. Raises InvalidRequest, which names everything that is wrong.
template <typename Wire>
auto RequestOf(py::handle scene, const py::dict& arguments) {
  Filler filler;
  Wire message;
  constexpr bool kHasSeveralContacts = std::is_same_v<Wire, v1::MultiContactRequest>;
  if constexpr (kHasSeveralContacts) filler.Fill(scene, *message.mutable_scene());
  for (const auto& [name, value] : arguments) filler.FillArgument(std::string(py::str(name)), value, message);
  auto request = FromProto(message);
  if constexpr (!kHasSeveralContacts) SceneIn(request) = SceneOf(scene, filler);
  filler.Finish();
  return request;
}

}  // namespace ricochet::python

#endif  // RICOCHET_PYTHON_MODULE_REQUEST_H_
