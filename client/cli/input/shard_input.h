// ShardInput: which part of a sweep a run computes, from flags or from what Slurm, Kubernetes and Open MPI tell the
// tasks that they start.

#ifndef RICOCHET_CLIENT_CLI_INPUT_SHARD_INPUT_H_
#define RICOCHET_CLIENT_CLI_INPUT_SHARD_INPUT_H_

#include <cstdint>
#include <string>

#include "absl/status/statusor.h"

namespace CLI {
class App;
}

namespace ricochet::cli {

struct ShardInput {
  bool from_environment = false;
  std::string index;  // Empty: the environment says it.
  std::string count;  // Empty: the environment says it.

  // True if the run computes a shard instead of the whole sweep.
  bool any() const { return from_environment || !index.empty() || !count.empty(); }
};

void AddShardOptions(CLI::App& app, ShardInput& input);

// True if an option of shards was given, so that -o names files which have a format of their own.
bool WritesShard(const CLI::App& app);

// Shard `index` of `count`; 0 <= index < count.
struct ShardNumber {
  int64_t index = 0;
  int64_t count = 1;
};

// Returns the shard of this run. A flag wins over the environment. With --shard-count the number of a task of a Slurm
// array is the index itself, so that an array of a few of the tasks repeats these alone; without it the array's size is
// the count and its first task has index 0. Errors: INVALID_ARGUMENT if a number is missing or wrong, or if more than
// one of the three systems started this run.
absl::StatusOr<ShardNumber> FindShard(const ShardInput& input);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_INPUT_SHARD_INPUT_H_
