// CopyDoubles: takes doubles from the bytes of a column.

#ifndef RICOCHET_PROTO_WIRE_COLUMN_BYTES_H_
#define RICOCHET_PROTO_WIRE_COLUMN_BYTES_H_

#include <algorithm>
#include <string>

#include "absl/types/span.h"

namespace ricochet {

// Fills `doubles` from the first of `bytes`, which may lie at any address. Unlike memcpy, std::copy_n may be given the
// address of an empty span, which is null.
inline void CopyDoubles(const std::string& bytes, absl::Span<double> doubles) {
  std::copy_n(bytes.data(), doubles.size() * sizeof(double), reinterpret_cast<char*>(doubles.data()));
}

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_COLUMN_BYTES_H_
