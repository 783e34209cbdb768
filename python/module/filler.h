// Filler: a message of the service from what a caller of Python gives: dictionaries with the names of its fields, whose
// values are numbers, texts, lists and arrays.
//
// The descriptor of the message says which fields there are, so that no field is named here. What is wrong is collected
// and raised at once, as InvalidRequest: unknown fields with the nearest name, values of a wrong kind, two alternatives
// of one choice. None leaves a field unset. Python decides what counts as a number (ricochet/values.py) wherever it is
// not a plain int or float.

#ifndef RICOCHET_PYTHON_MODULE_FILLER_H_
#define RICOCHET_PYTHON_MODULE_FILLER_H_

#include <google/protobuf/message.h>
#include <pybind11/pybind11.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/string_view.h"
#include "python/module/exceptions.h"
#include "ricochet/error.h"

namespace ricochet::python {

// The path of a field: the place of what holds it, its name, and its index in a list. It becomes text only if something
// is wrong there.
struct Place {
  const Place* outer = nullptr;
  absl::string_view name;
  int index = -1;

  std::string Text() const;
};

// Returns the argument of Python that sets a field of a request; the field if it has its name.
absl::string_view ArgumentOf(absl::string_view field);

class Filler {
 public:
  // Fills `message` from a dictionary. `place` is null for a scene, whose fields have no other path.
  void Fill(py::handle values, google::protobuf::Message& message, const Place* place = nullptr);

  // Sets the field that an argument of a function of Python means ("tolerance" for relative_tolerance). None and ()
  // leave it as it is.
  void FillArgument(absl::string_view argument, py::handle value, google::protobuf::Message& message);

  // Raises InvalidRequest if something was wrong.
  void Finish() const {
    if (!violations_.empty()) Raise(violations_);
  }

 private:
  using Message = google::protobuf::Message;
  using Field = google::protobuf::FieldDescriptor;

  void FillField(py::handle value, Message& message, const Field& field, const Place& place);
  void FillList(py::handle value, Message& message, const Field& field, const Place& place);
  // Fills the entries of W (2 x 2 in a plane, 3 x 3 in space) of a contact, or M (n x n) or J (d x n) of a mechanism.
  // `beside` has the other values of the message. Returns false if the value is no matrix, but may be another list.
  bool FillMatrix(py::handle value, Message& message, const Place& place, const py::dict& beside);
  // Sets a field that is no message, or adds to it if it is a list.
  void Put(py::handle value, Message& message, const Field& field, const Place& place);
  std::optional<double> Number(py::handle value, const Place& place);
  std::optional<int> EnumNumber(py::handle value, const google::protobuf::EnumDescriptor& type, const Place& place);
  // Calls NAME of ricochet.values. Returns null if it raises InvalidRequest, whose violations are kept.
  template <typename... Arguments>
  py::object Ask(const char* name, Arguments&&... arguments);

  void Refuse(const Place& place, std::string description) {
    violations_.push_back({place.Text(), std::move(description)});
  }

  std::vector<Violation> violations_;
  bool has_several_contacts_ = false;
};

}  // namespace ricochet::python

#endif  // RICOCHET_PYTHON_MODULE_FILLER_H_
