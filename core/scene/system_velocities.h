// The velocities of a system after an impact, in the order in which an outcome lists them.

#ifndef RICOCHET_CORE_SCENE_SYSTEM_VELOCITIES_H_
#define RICOCHET_CORE_SCENE_SYSTEM_VELOCITIES_H_

#include <string>
#include <vector>

#include "ricochet/system.h"

namespace ricochet {

// Their paths in an outcome: "rates_after[0]", "bodies_after[0].linear_m_s[1]". A contact alone has none.
std::vector<std::string> SystemVelocityPaths(const System& system);

}  // namespace ricochet

#endif  // RICOCHET_CORE_SCENE_SYSTEM_VELOCITIES_H_
