// Converts the requests and chunks of sweeps to their protos and back.

#ifndef RICOCHET_PROTO_WIRE_SWEEP_H_
#define RICOCHET_PROTO_WIRE_SWEEP_H_

#include "ricochet/sweep.h"
#include "ricochet/v1/sweep.pb.h"

namespace ricochet {

v1::SweepRequest ToProto(const SweepRequest& request);
SweepRequest FromProto(const v1::SweepRequest& proto);

// An unknown Combination keeps its number both ways, for ValidateAxes to report.
v1::SweepRequest::Combination ToProto(Combination combination);
Combination FromProto(v1::SweepRequest::Combination proto);

v1::Tally ToProto(const Tally& tally);
Tally FromProto(const v1::Tally& proto);

// A number that this build does not know becomes kUnspecified.
v1::RowStatus ToProto(RowStatus status);
RowStatus FromProto(v1::RowStatus proto);

// Points with regimes that this build does not know are counted together as kUnspecified.
v1::SweepSummary ToProto(const SweepSummary& summary);
SweepSummary FromProto(const v1::SweepSummary& proto);

// Sets or clears every field of `proto`, whose capacity is reused. The seal is cleared: proto/wire/chunk_seal.h puts it on.
void ToProto(const SweepChunk& chunk, v1::SweepResponse& proto);
// Values that end in the middle of a double lose its part.
SweepChunk FromProto(const v1::SweepResponse& proto);

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_SWEEP_H_
