// Inertia tensors of bodies in space.

#ifndef RICOCHET_CORE_CONTACT_INERTIA_H_
#define RICOCHET_CORE_CONTACT_INERTIA_H_

#include <vector>

namespace ricochet {

// The largest principal moment of a positive definite inertia tensor divided by the sum of all three. The tensor of a
// body has at most 1/2, which a flat plate and a thin rod reach, because no moment exceeds the sum of the other two.
// `upper` is the upper triangle of the symmetric 3 x 3 matrix, row by row.
double LargestMomentShare(const std::vector<double>& upper);

}  // namespace ricochet

#endif  // RICOCHET_CORE_CONTACT_INERTIA_H_
