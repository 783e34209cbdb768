// SolveSingleImpact: the impact of one contact among several, by the models of one contact, with what an error of the
// velocity before makes of its impulse.
//
// The contact has its block W_ii, its velocity x = (u, v) with v < 0, and the impulse P(x). P is homogeneous of degree
// one, so that its derivative D = dP/dx satisfies D x = P: one difference quotient in a plane, and two in space, give
// all of it. Errors are those of the models; D is accurate to about 1e-5 of its size, except at a velocity where the
// course of the impact changes. docs/theory/several_contacts.md says what is made of it.

#ifndef RICOCHET_CORE_MULTI_SINGLE_IMPACT_H_
#define RICOCHET_CORE_MULTI_SINGLE_IMPACT_H_

#include <Eigen/Core>

#include "core/multi/problem.h"

namespace ricochet::multi {

// Vectors and matrices of one contact.
using ContactVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::DontAlign, 3, 1>;
using ContactBlock = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::DontAlign, 3, 3>;

struct SingleImpact {
  bool ended = true;    // False if the contact jams, so that its impact has no end; nothing else is set then.
  bool locked = false;  // True if friction and the joints hold the contact at rest, so that its force need not fall.
  ContactVector impulse, velocity;
  ContactWorks works;
  // Errors of each component of the velocity, of each component of the impulse, and of each work, which may be
  // infinite.
  double velocity_error = 0.0, tangential_error = 0.0, normal_error = 0.0, work_error = 0.0;
  // False if only such errors of the impulse are known as change a velocity, as in space where friction and the joints
  // lock the contact.
  bool impulse_is_known = true;
  bool error_is_proved = true;  // False if an error, or D, is an estimate.
  ContactBlock derivative;      // D
};

// `velocity` is that of contact i, which approaches.
SingleImpact SolveSingleImpact(const Problem& problem, int i, const ContactVector& velocity);

}  // namespace ricochet::multi

#endif  // RICOCHET_CORE_MULTI_SINGLE_IMPACT_H_
