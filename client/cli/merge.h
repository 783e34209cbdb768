// ricochet merge: one file from the shards of a sweep.

#ifndef RICOCHET_CLIENT_CLI_MERGE_H_
#define RICOCHET_CLIENT_CLI_MERGE_H_

#include "client/cli/common.h"

namespace ricochet::cli {

void AddMerge(CLI::App& app, Command& command);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_MERGE_H_
