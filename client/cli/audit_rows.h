// ricochet audit --data: many observed impacts, one on each line of a table, which may be longer than the memory.

#ifndef RICOCHET_CLIENT_CLI_AUDIT_ROWS_H_
#define RICOCHET_CLIENT_CLI_AUDIT_ROWS_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "client/cli/input/command_options.h"
#include "client/cli/plot/picture_input.h"
#include "ricochet/solver.h"

namespace ricochet::cli {

struct AuditDataOptions {
  std::string file;  // "-" for standard input.
  std::vector<std::string> skipped_columns;
  std::optional<double> uncertainty_m_s;  // Every row has it, in place of a column.
  bool list = false;                      // Text also names each row that is not admissible, and why.
  bool strict = false;                    // A row that is not admissible is an error.
  PictureOptions picture;
};

// Audits the table part by part, so that its length does not matter, and writes each part before it reads the next. A
// bar shows the progress. Text has the summary, csv a line for each row, json one object with all reports.
// Errors: INVALID_ARGUMENT for a table that cannot be read; CANCELLED by Ctrl-C; FAILED_PRECONDITION under `strict`,
// after everything was written; those of the solver, the output and the picture.
absl::Status AuditData(const AuditDataOptions& data, const CommonOptions& options, const Solver& solver,
                       const Scene& scene);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_AUDIT_ROWS_H_
