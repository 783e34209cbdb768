// Request: a request of Python on its way to a solver: the arguments of a function as a message of the service, and the
// scene.

#ifndef RICOCHET_PYTHON_MODULE_REQUEST_H_
#define RICOCHET_PYTHON_MODULE_REQUEST_H_

#include <google/protobuf/message.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <vector>

#include "core/base/invariant.h"
#include "ricochet/scene.h"

namespace ricochet::python {

// The names that a caller may give, as a collection of Python that is searched without being copied.
struct Paths {
  std::vector<std::string> texts;
};

class Request {
 public:
  // Makes a message of ricochet.v1, which has a scene, from the arguments of a function of Python.
  Request(const std::string& type, pybind11::handle scene, const pybind11::dict& arguments);

  // Sets further fields from a dictionary.
  void Set(const pybind11::dict& fields);

  const Scene& scene() const { return scene_; }
  Paths Fields() const;
  Paths Columns() const;

  // The message, whose scene is not set.
  template <typename Wire>
  const Wire& As() const {
    const auto* const message = dynamic_cast<const Wire*>(message_.get());
    CheckInvariant(message != nullptr, "a function of Python makes the request of its own call");
    return *message;
  }

 private:
  std::unique_ptr<google::protobuf::Message> message_;
  Scene scene_;
};

// Adds the class to the module.
void AddRequest(pybind11::module_& module);

}  // namespace ricochet::python

#endif  // RICOCHET_PYTHON_MODULE_REQUEST_H_
