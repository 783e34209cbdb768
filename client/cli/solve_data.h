// `ricochet solve --data`: many impacts of one system, the rows of a table.

#ifndef RICOCHET_CLIENT_CLI_SOLVE_DATA_H_
#define RICOCHET_CLIENT_CLI_SOLVE_DATA_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "client/cli/input/command_options.h"
#include "ricochet/demand.h"
#include "ricochet/scene.h"
#include "ricochet/solver.h"

namespace ricochet::cli {

struct DataOptions {
  std::string file;                          // A table; - for standard input.
  std::vector<std::string> skipped_columns;  // Columns of the table that are left out.
  std::vector<std::string> columns;  // Columns of the outcome. Empty: the contact's velocity after and the impulse.
  bool strict = false;               // A row that has no numbers, or is inadmissible, is an error.
};

// Solves the rows and writes them as the options ask. The header may have short names (client/cli/input/short_name.h).
// Errors: those of reading, of the solver and of Output; FAILED_PRECONDITION under `strict`, after everything was
// written.
absl::Status SolveData(const DataOptions& data, const CommonOptions& options, const Solver& solver, const Scene& scene,
                       const DemandFields& demand);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_SOLVE_DATA_H_
