// DemandEntries: the fields of a demand, which stand in the message of each request that makes one.

#ifndef RICOCHET_PROTO_WIRE_DEMAND_H_
#define RICOCHET_PROTO_WIRE_DEMAND_H_

#include "proto/wire/map.h"
#include "proto/wire/plan.h"
#include "ricochet/demand.h"

namespace ricochet {

template <typename P>
using DemandEntries = Entries<Entry(&DemandFields::relative_tolerance, &P::has_relative_tolerance,
                                    &P::relative_tolerance, &P::set_relative_tolerance),
                              Entry(&DemandFields::required, &P::required, &P::mutable_required),
                              Entry(&DemandFields::excluded, &P::excluded, &P::mutable_excluded)>;

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_DEMAND_H_
