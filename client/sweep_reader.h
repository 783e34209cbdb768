// SweepReader: the receiving end of a sweep. It reads the server's stream and checks that no point is missing.

#ifndef RICOCHET_CLIENT_SWEEP_READER_H_
#define RICOCHET_CLIENT_SWEEP_READER_H_

#include "client/chunk_checker.h"
#include "client/stream_reader.h"
#include "ricochet/sweep.h"
#include "ricochet/v1/sweep.pb.h"

namespace ricochet {

using SweepReader = StreamReader<v1::SweepResponse, SweepChunk, ChunkChecker>;

}  // namespace ricochet

#endif  // RICOCHET_CLIENT_SWEEP_READER_H_
