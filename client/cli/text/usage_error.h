// Errors of the command line's words: subcommands and flags that do not exist.

#ifndef RICOCHET_CLIENT_CLI_TEXT_USAGE_ERROR_H_
#define RICOCHET_CLIENT_CLI_TEXT_USAGE_ERROR_H_

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace ricochet::cli {

// Returns what to tell a user whose command line `app` has refused with `error`: a subcommand or a flag that does not
// exist is named, with the nearest one that does.
std::string UsageError(const CLI::App& app, const CLI::ParseError& error);

// Returns what the parser would not say of these words, empty if nothing: it would give the next word to an option with
// an empty value ("--server="), or an option to one that lacks its value, and take "-o=x.csv" for the file "=x.csv".
std::string ValueError(const CLI::App& app, const std::vector<std::string>& words);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_TEXT_USAGE_ERROR_H_
