// FitData: measured impacts as a table of CSV, and what the flags say of unknowns and errors, as the request of a fit.

#ifndef RICOCHET_CLIENT_CLI_INPUT_FIT_DATA_H_
#define RICOCHET_CLIENT_CLI_INPUT_FIT_DATA_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "ricochet/fit.h"
#include "ricochet/scene.h"

namespace ricochet::cli {

// The options as they were typed. Names may be short (client/cli/input/short_name.h).
struct FitDataOptions {
  std::string file;
  std::vector<std::string> skipped_columns;
  std::vector<std::string> unknowns;  // NAME or NAME=START
  std::vector<std::string> bounds;    // NAME=LOW:HIGH, where either number may be left out.
  std::vector<std::string> sigmas;    // NAME=SIGMA
  std::vector<std::string> region;    // Two names, or none.
};

// Reads the table. A column whose name is a number of the scene is an input, one whose name is a number of the outcome
// is measured, and NAME.sigma has the standard deviations of NAME. An empty cell of a measured number, or of a sigma
// beside one, was not measured.
// Errors: INVALID_ARGUMENT that names the option, or the column and the line.
absl::StatusOr<FitRequest> ReadFit(const FitDataOptions& options, const Scene& scene);

// Returns the error of a request that ReadFit has made, with the rows and columns of the table and the options in place
// of the fields that have them.
absl::Status InTheTable(const FitRequest& request, const absl::Status& status);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_INPUT_FIT_DATA_H_
