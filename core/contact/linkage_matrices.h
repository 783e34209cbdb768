// Linkage matrices: mass matrix, Jacobian and moments of gravity of a linkage. The generalised coordinates are the
// absolute angles of the links. This header includes Eigen.

#ifndef RICOCHET_CORE_CONTACT_LINKAGE_MATRICES_H_
#define RICOCHET_CORE_CONTACT_LINKAGE_MATRICES_H_

#include <Eigen/Core>

#include "ricochet/scene.h"

namespace ricochet {

// M_ij = cos(theta_i - theta_j) sum over links k of m_k a_ki a_kj, where a_ki is length_i for links i before k, com_k
// for k itself and 0 for links after k. The links' moments of inertia are added on the diagonal. Units are kg m^2.
Eigen::MatrixXd MassMatrix(const Linkage& linkage);

// d(tip)/d(theta) in m: one row for each link, columns t and n.
Eigen::MatrixXd TransposedJacobian(const Linkage& linkage);

// The angular velocities of the links, rad/s.
Eigen::VectorXd RatesOf(const Linkage& linkage);

// The derivatives of both along `direction`, a linkage whose numbers are the changes of those of `linkage`.
Eigen::MatrixXd MassMatrixTangent(const Linkage& linkage, const Linkage& direction);
Eigen::MatrixXd TransposedJacobianTangent(const Linkage& linkage, const Linkage& direction);

// The moments of gravity about the joints, N m.
Eigen::VectorXd GravityMoments(const Linkage& linkage, const Gravity& gravity);

}  // namespace ricochet

#endif  // RICOCHET_CORE_CONTACT_LINKAGE_MATRICES_H_
