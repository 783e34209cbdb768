// Errors of the command line's words: subcommands and flags that do not exist.

#ifndef RICOCHET_CLIENT_CLI_TEXT_USAGE_ERROR_H_
#define RICOCHET_CLIENT_CLI_TEXT_USAGE_ERROR_H_

#include <CLI/App.hpp>
#include <string>

namespace ricochet::cli {

// Returns what to tell a user whose command line `app` has refused with `error`: a subcommand or a flag that does not
// exist is named, with the nearest one that does.
std::string UsageError(const CLI::App& app, const CLI::ParseError& error);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_TEXT_USAGE_ERROR_H_
