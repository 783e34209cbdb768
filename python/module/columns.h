// Columns: rows that are messages of one type, as arrays of NumPy.

#ifndef RICOCHET_PYTHON_MODULE_COLUMNS_H_
#define RICOCHET_PYTHON_MODULE_COLUMNS_H_

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>
#include <pybind11/pybind11.h>

#include <string>
#include <vector>

namespace ricochet::python {

struct Columns {
  pybind11::dict numbers;  // Arrays of doubles by the paths of the fields, NaN where a row does not set the field.
  pybind11::dict codes;    // Arrays of the numbers of enums, likewise; 0 where a row does not set the field.
};

// Adds a column for each number and enum in messages of `type`, whose paths begin with `path`. A list has as many as
// its longest in any row; a message that no row sets has none. `rows` has null for a row without the message.
void AddColumns(const google::protobuf::Descriptor& type, const std::vector<const google::protobuf::Message*>& rows,
                const std::string& path, Columns& columns);

}  // namespace ricochet::python

#endif  // RICOCHET_PYTHON_MODULE_COLUMNS_H_
