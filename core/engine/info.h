// InfoOf: says which engine this is, what it can answer, and within which limits.

#ifndef RICOCHET_CORE_ENGINE_INFO_H_
#define RICOCHET_CORE_ENGINE_INFO_H_

#include "ricochet/info.h"
#include "ricochet/limits.h"

namespace ricochet {

InfoResponse InfoOf(const Limits& limits);

}  // namespace ricochet

#endif  // RICOCHET_CORE_ENGINE_INFO_H_
