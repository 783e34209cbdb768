// Matrices in JSON as people write them, as lists of their rows: mass_matrix and jacobian of a mechanism, and W, 2 x 2
// in a planar_contact, 3 x 3 in a spatial_contact and square in a contact_matrix, under the name w_per_kg.

#ifndef RICOCHET_PROTO_TEXT_JSON_MATRICES_H_
#define RICOCHET_PROTO_TEXT_JSON_MATRICES_H_

#include <string>

#include "absl/status/statusor.h"

namespace ricochet {

// Returns the text with each such matrix written as the proto has it: row by row, or as the entries of W. Everything
// else stays as it is, in the same lines. A matrix that is a flat list stays, too.
// Errors: INVALID_ARGUMENT names rows of unequal lengths, a W of another size, and entries of W that differ across the
// diagonal, with the frame.
absl::StatusOr<std::string> WithFlatMatrices(const std::string& text);

}  // namespace ricochet

#endif  // RICOCHET_PROTO_TEXT_JSON_MATRICES_H_
