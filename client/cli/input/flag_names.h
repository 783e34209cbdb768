// Names of flags in errors: a user who gave a number by a flag is told which flag is meant, not only which field.

#ifndef RICOCHET_CLIENT_CLI_INPUT_FLAG_NAMES_H_
#define RICOCHET_CLIENT_CLI_INPUT_FLAG_NAMES_H_

#include <CLI/App.hpp>

#include "absl/status/status.h"

namespace ricochet::cli {

// Returns the error of a run with the flag before each field that a flag of the request, of a connection or of a
// pendulum sets, such as "--a: pendulum.a_m"; where a flag was given several times, with its text: "--axis mu=nan:
// axes[0]". A field of a pendulum whose flag was not given is missing. Errors of scenes from files stay as they are.
absl::Status NameFlags(const CLI::App& app, const absl::Status& error);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_INPUT_FLAG_NAMES_H_
