// Records: what a message of the service looks like in Python. ricochet/record.py has their class, a dictionary whose
// entries can be read as attributes.
//
// The descriptor of the message says which entries there are. An enum is its name without the prefix that all its names
// have; what is not set is None. Each function needs the lock of Python.

#ifndef RICOCHET_PYTHON_MODULE_RECORD_H_
#define RICOCHET_PYTHON_MODULE_RECORD_H_

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>
#include <pybind11/pybind11.h>

#include <memory>

#include "ricochet/solver.h"

namespace ricochet::python {

// Returns the name of a number that the enum has: "REBOUND". EnumNames has those of all its numbers, which are 0, 1,
// ...
pybind11::object EnumName(const google::protobuf::EnumDescriptor& type, int number);
pybind11::list EnumNames(const google::protobuf::EnumDescriptor& type);

// Returns the names of all fields that a message may have.
pybind11::list FieldNames(const google::protobuf::Descriptor& type);

// Returns the message as a record.
pybind11::object RecordOf(const google::protobuf::Message& message);

// Returns what is set in a message as a dictionary.
pybind11::dict DictionaryOf(const google::protobuf::Message& message);

// Returns the outcome as a record whose entries are made when they are first asked for, because making all of them
// takes ten times as long as solving a scene in a plane.
pybind11::object UnreadRecordOf(std::unique_ptr<SolveResponse> response);

// Returns an entry of a record that UnreadRecordOf has made; null if there is none of that name.
pybind11::object ReadEntry(pybind11::handle record, pybind11::handle name);

// Makes all entries of such a record, and gives it the class of one that is read.
void ReadRecord(pybind11::handle record);

}  // namespace ricochet::python

#endif  // RICOCHET_PYTHON_MODULE_RECORD_H_
