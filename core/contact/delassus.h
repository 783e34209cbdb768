// The Delassus matrix W = J M^-1 J^T of a contact (its inverse inertia, 1/kg), and the only place that decides its
// rank.
//
// W is symmetric and positive semidefinite up to the rounding of its entries. Its determinant counts as zero if the
// rounding of the entries could have produced it: |det W| <= 4 eps Wtt Wnn in the plane, with eps = 2^-52. In space the
// minors with n are compared in this way, and det W is compared with the sum of the magnitudes of its terms.
// The result does not depend on the scale of W: entries may lie anywhere in the range of doubles.
// The entries must be finite and the diagonal >= 0; core/scene/validate.h refuses any other W.

#ifndef RICOCHET_CORE_CONTACT_DELASSUS_H_
#define RICOCHET_CORE_CONTACT_DELASSUS_H_

#include <array>
#include <cmath>
#include <limits>

#include "core/numerics/products.h"

namespace ricochet {

// A determinant of at most this many times the product of the diagonal counts as rounding alone.
inline constexpr double kRankTolerance = 4.0 * std::numeric_limits<double>::epsilon();

// A velocity lies in the range of a W of rank one if |u Wnn - v Wtn| is at most this many times the sum of both terms:
// the rounding of u and v takes it that far.
inline constexpr double kRangeTolerance = 8.0 * std::numeric_limits<double>::epsilon();

struct PlanarDelassus {
  double tt = 0.0, tn = 0.0, nn = 0.0;

  // det W/(Wtt Wnn), with the limits that core/numerics/products.h states.
  double RelativeDeterminant() const { return ricochet::RelativeDeterminant(tt, tn, nn); }
  bool IsSemidefinite() const { return RelativeDeterminant() >= -kRankTolerance; }
  // 0 for W = 0, else 1 or 2.
  int Rank() const {
    if (tt == 0.0 && nn == 0.0) return 0;
    return std::abs(RelativeDeterminant()) <= kRankTolerance ? 1 : 2;
  }
  // True if W has rank one and (u, v) lies in its range, so that impulses keep u = v Wtn/Wnn, and u and v vanish
  // together. Where Wtt = 0 no impulse changes u, and it is false.
  bool UFollowsV(double u, double v) const {
    if (!(tt > 0.0) || !(nn > 0.0) || Rank() != 1) return false;
    return ProductsAgree(u, nn, v, tn, kRangeTolerance);
  }
};

// The third direction is n. Entries are the upper triangle, row by row: 11, 12, 13, 22, 23, 33.
struct SpatialDelassus {
  std::array<double, 6> w = {};

  // 1, 2 or 3.
  int Rank() const;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_CONTACT_DELASSUS_H_
