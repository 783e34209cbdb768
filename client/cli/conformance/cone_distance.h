// Says how far a change of velocity lies from all that impulses within the friction cones can cause.

#ifndef RICOCHET_CLIENT_CLI_CONFORMANCE_CONE_DISTANCE_H_
#define RICOCHET_CLIENT_CLI_CONFORMANCE_CONE_DISTANCE_H_

#include <Eigen/Core>

#include "client/cli/conformance/cases.h"

namespace ricochet::cli {

// Returns what is left of the change of velocity after the impulse within the friction cones of the case that leaves
// the least kinetic energy. It is 0 to rounding exactly if some impulse within the cones causes the change. In space a
// cone is replaced by the pyramid inside it that has an edge along the tangential impulse of the change: what is left
// of a change outside the cones may then be larger. A case in space has one contact.
Eigen::VectorXd OutsideCones(const ConformanceCase& one, const Eigen::VectorXd& change);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_CONFORMANCE_CONE_DISTANCE_H_
