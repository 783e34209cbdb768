// Reduce: the contacts of several bodies, or of a mechanism, as one matrix W and one velocity.
//
//   W = J M^-1 J^T,   v = J q',   q'+ = q' + M^-1 J^T p
//
// The d = 2 or 3 rows of J for a contact have the order t, n or t1, t2, n (ricochet/multi_contact.h). W is computed
// entry by entry from what each body adds, so that neither the order of the contacts nor a mirror image changes its
// bits. Accuracy: a few eps of the magnitudes of the terms, times the condition of a body's inertia; of a mechanism
// that of core/contact/mechanism.h. The scene must be valid (core/scene/validate_multi.h). If a product overflows, a
// number is not finite. This header includes Eigen.

#ifndef RICOCHET_CORE_CONTACT_MULTI_REDUCTION_H_
#define RICOCHET_CORE_CONTACT_MULTI_REDUCTION_H_

#include <Eigen/Core>

#include "ricochet/multi_contact.h"

namespace ricochet {

struct MultiReduction {
  int directions = 2;  // d
  Eigen::MatrixXd w;   // kd x kd
  // The velocities of a ContactMatrix are those of its contacts, so that J is the identity and M^-1 J^T is W.
  Eigen::MatrixXd jacobian;  // kd x n
  Eigen::MatrixXd response;  // M^-1 J^T, n x kd
  Eigen::VectorXd mobility;  // The diagonal of M^-1, or of W; 0 for a coordinate that is held.
  Eigen::VectorXd velocity;  // q' of the scene

  // The contact velocity that goes with velocities of the system: 0 where its terms cancel to rounding, so that a
  // contact at rest does not approach.
  Eigen::VectorXd ContactVelocity(const Eigen::VectorXd& velocities) const;
};

MultiReduction Reduce(const MultiContactScene& scene);

// The directions of a contact in the coordinates of the bodies, one in each row: t, n or t1, t2, n.
Eigen::MatrixXd ContactDirections(const MultiContactPoint& contact);

// The largest distance of a component of the velocity from the range of W, over sqrt(W_jj), and over the norm of the
// magnitudes that the velocity is a sum of, in the same unit; infinite if W_jj is 0 and the component is not.
double DistanceFromRange(const Eigen::MatrixXd& w, const Eigen::VectorXd& v, const Eigen::VectorXd& sizes);

}  // namespace ricochet

#endif  // RICOCHET_CORE_CONTACT_MULTI_REDUCTION_H_
