// kDemandEntries: the fields of a demand, which stand in the message of each request that makes one.

#ifndef RICOCHET_PROTO_WIRE_DEMAND_H_
#define RICOCHET_PROTO_WIRE_DEMAND_H_

#include "proto/wire/map.h"
#include "proto/wire/plan.h"
#include "ricochet/demand.h"

namespace ricochet {

inline constexpr auto kDemandEntries =
    Entries(RICOCHET_FIELD(relative_tolerance), RICOCHET_FIELD(required), RICOCHET_FIELD(excluded));

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_DEMAND_H_
