// Converts lists of doubles to packed fields and back, and takes them from the bytes of a column, each by one copy of
// memory.

#ifndef RICOCHET_PROTO_WIRE_REPEATED_H_
#define RICOCHET_PROTO_WIRE_REPEATED_H_

#include <google/protobuf/repeated_field.h>

#include <algorithm>
#include <string>
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

// Fills `doubles` from the first of `bytes`, which may lie at any address. Unlike memcpy, std::copy_n may be given the
// address of an empty span, which is null.
inline void CopyDoubles(const std::string& bytes, absl::Span<double> doubles) {
  std::copy_n(bytes.data(), doubles.size() * sizeof(double), reinterpret_cast<char*>(doubles.data()));
}

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_REPEATED_H_
