// Contacts from W as a whole matrix, as people write it, in place of its upper triangle.
//
// W is 2 x 2 with rows t and n in a plane, and 3 x 3 with rows t1, t2 and n in space, row by row, 1/kg. `frame` names
// the axes in an error, such as "world axes rotated by R".
// Errors: INVALID_ARGUMENT names an entry below the diagonal that is not finite, and the two entries that differ, where
// W is not symmetric to 1e-9 of its diagonal. Smaller differences are those of a sum in another order, and the entry
// above the diagonal is taken. All other rules are those of PlanarContact and SpatialContact (ricochet/system.h), which
// the solver checks.

#ifndef RICOCHET_CONTACT_MATRIX_H_
#define RICOCHET_CONTACT_MATRIX_H_

#include <array>
#include <span>
#include <string_view>

#include "absl/status/statusor.h"
#include "ricochet/system.h"

namespace ricochet {

absl::StatusOr<PlanarContact> ContactFrom(std::span<const double, 4> w_per_kg, double tangential_m_s, double normal_m_s,
                                          std::string_view frame = "t, n");
absl::StatusOr<SpatialContact> ContactFrom(std::span<const double, 9> w_per_kg, std::array<double, 2> tangential_m_s,
                                           double normal_m_s, std::string_view frame = "t1, t2, n");

}  // namespace ricochet

#endif  // RICOCHET_CONTACT_MATRIX_H_
