// Says which numbers of an outcome have derivatives, and by which numbers of the scene.

#ifndef RICOCHET_CORE_ANSWER_DERIVATIVE_PATHS_H_
#define RICOCHET_CORE_ANSWER_DERIVATIVE_PATHS_H_

#include <string>
#include <vector>

#include "ricochet/demand.h"
#include "ricochet/derivatives.h"
#include "ricochet/error.h"
#include "ricochet/scene.h"

namespace ricochet {

// Every number of an outcome of the scene that has derivatives, and every number of the scene by which it has them. The
// scene must be valid.
DerivativePaths AllDerivativePaths(const Scene& scene);

// Adds a violation for an empty list of paths, "of" or "by", and one for each path that is not `known`; `what` says
// what a path must name.
void CheckPaths(const char* list, const std::vector<std::string>& paths, const std::vector<std::string>& known,
                const char* what, std::vector<Violation>& violations);

// Lists why derivatives cannot be given for a valid scene: excluded effects, or paths that name no such number.
std::vector<Violation> CheckDerivatives(const Scene& scene, const DemandFields& demand, const DerivativePaths& paths);

}  // namespace ricochet

#endif  // RICOCHET_CORE_ANSWER_DERIVATIVE_PATHS_H_
