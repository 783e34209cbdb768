// Sweeps <-> ricochet.v1.SweepRequest, SweepResponse.

#ifndef RICOCHET_PROTO_WIRE_SWEEP_H_
#define RICOCHET_PROTO_WIRE_SWEEP_H_

#include "core/sweep/sweep.h"
#include "ricochet/v1/sweep.pb.h"

namespace ricochet {

v1::SweepRequest ToProto(const SweepRequest& request);
// An unknown Combination keeps its number, for ValidateAxes to report.
SweepRequest FromProto(const v1::SweepRequest& proto);

v1::SweepSummary ToProto(const SweepSummary& summary);
SweepSummary FromProto(const v1::SweepSummary& proto);

// `proto` is reused: its capacity is kept.
void ToProto(const SweepChunk& chunk, v1::SweepResponse& proto);
SweepChunk FromProto(const v1::SweepResponse& proto);

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_SWEEP_H_
