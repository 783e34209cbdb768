// The matrices of a linkage: mass, Jacobian, gravity. Needs Eigen; the angles are the joints' coordinates.

#ifndef RICOCHET_CORE_CONTACT_LINKAGE_MATRICES_H_
#define RICOCHET_CORE_CONTACT_LINKAGE_MATRICES_H_

#include <Eigen/Core>

#include "ricochet/scene.h"

namespace ricochet {

// M_ij = cos(theta_i - theta_j) sum over links k of m_k a_ki a_kj, with a_ki = length_i for links i before k, com_k for
// k itself, 0 after; and the inertias on the diagonal.
Eigen::MatrixXd MassMatrix(const Linkage& linkage);

// d(tip)/d(theta), a row a link, columns t and n.
Eigen::MatrixXd TransposedJacobian(const Linkage& linkage);

// The moments that gravity has about the joints.
Eigen::VectorXd GravityMoments(const Linkage& linkage, const Gravity& gravity);

}  // namespace ricochet

#endif  // RICOCHET_CORE_CONTACT_LINKAGE_MATRICES_H_
