// Converts lists of doubles to packed fields and back, each by one memcpy.

#ifndef RICOCHET_PROTO_WIRE_REPEATED_H_
#define RICOCHET_PROTO_WIRE_REPEATED_H_

#include <google/protobuf/repeated_field.h>

#include <vector>

#include "absl/types/span.h"
#include "ricochet/outcome.h"

namespace ricochet {

// Keeps the capacity of `field`.
inline void AssignDoubles(absl::Span<const double> values, google::protobuf::RepeatedField<double>& field) {
  field.Assign(values.begin(), values.end());
}

inline std::vector<double> ToVector(const google::protobuf::RepeatedField<double>& field) {
  // The pointers make the copy a memcpy, which the library's iterators prevent.
  return {field.data(), field.data() + field.size()};
}

inline Components ToComponents(const google::protobuf::RepeatedField<double>& field) {
  return {field.data(), field.data() + field.size()};
}

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_REPEATED_H_
