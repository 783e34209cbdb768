// CheckCoverage: whether shards are those of one sweep and have each of its points once.

#ifndef RICOCHET_CLIENT_CLI_SWEEP_SHARD_COVERAGE_H_
#define RICOCHET_CLIENT_CLI_SWEEP_SHARD_COVERAGE_H_

#include <vector>

#include "absl/status/status.h"
#include "client/cli/sweep/shard.h"

namespace ricochet::cli {

// Sorts the shards by their points. There must be at least one. Shards of different counts may make up one sweep.
// Errors: INVALID_ARGUMENT for shards of different sweeps; FAILED_PRECONDITION for those of different engines, for
// points in no shard, and for points in two; the message names them all, up to 20. DATA_LOSS for a manifest that
// contradicts itself.
absl::Status CheckCoverage(std::vector<ShardFile>& shards);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_SWEEP_SHARD_COVERAGE_H_
