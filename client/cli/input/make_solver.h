// The solver behind a subcommand: the engine in this process, or servers.

#ifndef RICOCHET_CLIENT_CLI_INPUT_MAKE_SOLVER_H_
#define RICOCHET_CLIENT_CLI_INPUT_MAKE_SOLVER_H_

#include <memory>
#include <optional>

#include "absl/status/statusor.h"
#include "client/cli/input/command_options.h"
#include "ricochet/client_options.h"
#include "ricochet/solver.h"

namespace ricochet::cli {

// Returns the options of a client of the server that is named. Errors: INVALID_ARGUMENT, also if none is named.
absl::StatusOr<ClientOptions> MakeClientOptions(const CommonOptions& options);

// Returns a LocalSolver, or a Client if a server is given. `threads` are those of the LocalSolver, >= 1; absent: one
// for each core; `limits` are its, too. With `fan_out` all servers of --server compute a sweep together.
// Errors: INVALID_ARGUMENT, also for threads beside a server, and for less than two servers with `fan_out`.
absl::StatusOr<std::unique_ptr<Solver>> MakeSolver(const CommonOptions& options, std::optional<int> threads = {},
                                                   const Limits& limits = Limits::None(), bool fan_out = false);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_INPUT_MAKE_SOLVER_H_
