#include "client/cli/usage_error.h"

#include <CLI/App.hpp>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "core/scene/nearest.h"

namespace ricochet::cli {
namespace {

std::vector<std::string> SubcommandNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* sub : app.get_subcommands({})) names.push_back(sub->get_name());
  return names;
}

std::vector<std::string> FlagNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::string NoSuchSubcommand(const CLI::App& app, const std::string& word) {
  const std::vector<std::string> names = SubcommandNames(app);
  return absl::StrCat(word, " is not a subcommand", DidYouMean(word, names),
                      "\nSubcommands: ", absl::StrJoin(names, ", "), ". ricochet SUBCOMMAND --help says more.");
}

std::string NoSuchArgument(const CLI::App& sub, const std::string& word) {
  const std::string help = absl::StrCat("\nricochet ", sub.get_name(), " --help lists the options.");
  if (!absl::StartsWith(word, "-")) return absl::StrCat(word, " is not expected here: must follow an option", help);
  const std::string flag = word.substr(0, word.find('='));
  return absl::StrCat(flag, " is not an option of ricochet ", sub.get_name(), DidYouMean(flag, FlagNames(sub)), help);
}

}  // namespace

std::string UsageError(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  const std::vector<std::string> extras = app.remaining(/*recurse=*/true);
  const bool is_extra = chosen.empty() || error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError);
  if (extras.empty() || !is_extra) return error.what();
  if (!chosen.empty()) return NoSuchArgument(*chosen.front(), extras.front());
  return absl::StartsWith(extras.front(), "-")
             ? absl::StrCat(extras.front(), " is not an option", DidYouMean(extras.front(), FlagNames(app)))
             : NoSuchSubcommand(app, extras.front());
}

}  // namespace ricochet::cli
