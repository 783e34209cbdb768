// The names of the values of an enum, without the words with which all of them begin: "REBOUND" for REGIME_REBOUND.

#ifndef RICOCHET_PYTHON_MODULE_ENUM_NAMES_H_
#define RICOCHET_PYTHON_MODULE_ENUM_NAMES_H_

#include <google/protobuf/descriptor.h>
#include <pybind11/pybind11.h>

#include <string>

namespace ricochet::python {

// Returns the words with which every name of the enum begins: "REGIME_".
std::string EnumPrefix(const google::protobuf::EnumDescriptor& type);

// Returns the name of a number that the enum has.
pybind11::object EnumName(const google::protobuf::EnumDescriptor& type, int number);

// Returns the names of the numbers 0, 1, 2, ...
pybind11::list EnumNames(const google::protobuf::EnumDescriptor& type);

}  // namespace ricochet::python

#endif  // RICOCHET_PYTHON_MODULE_ENUM_NAMES_H_
