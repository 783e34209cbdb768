#include "client/cli/text/usage_error.h"

#include <CLI/App.hpp>
#include <algorithm>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "core/base/nearest.h"

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

// The words by which a subcommand is called: "ricochet scene list".
std::string CallOf(const CLI::App& app) {
  return app.get_parent() == nullptr ? app.get_name() : absl::StrCat(CallOf(*app.get_parent()), " ", app.get_name());
}

std::string NoSuchSubcommand(const CLI::App& app, const std::string& word) {
  const std::vector<std::string> names = SubcommandNames(app);
  return absl::StrCat(word, " is not a subcommand", app.get_parent() == nullptr ? "" : " of " + CallOf(app),
                      DidYouMean(word, names), "\nSubcommands: ", absl::StrJoin(names, ", "), ". ", CallOf(app),
                      " SUBCOMMAND --help says more.");
}

std::string NoSubcommand(const CLI::App& app) {
  return absl::StrCat(CallOf(app), " needs a subcommand: ", absl::StrJoin(SubcommandNames(app), ", "));
}

std::string NoSuchArgument(const CLI::App& app, const std::string& word) {
  const std::string help = absl::StrCat("\n", CallOf(app), " --help lists the options.");
  if (!absl::StartsWith(word, "-")) return absl::StrCat(word, " is not expected here: must follow an option", help);
  const std::string flag = word.substr(0, word.find('='));
  const std::vector<std::string> names = FlagNames(app);
  if (std::find(names.begin(), names.end(), flag) != names.end()) {
    return absl::StrCat(flag, " is not expected here: must stand behind ", CallOf(app), " and before --", help);
  }
  // Two dashes and one letter begin too many names to suggest one of them.
  const auto longer = std::find_if(names.begin(), names.end(), [&flag](const std::string& name) {
    return flag.size() > 3 && absl::StartsWith(name, flag);
  });
  return absl::StrCat(flag, " is not an option of ", CallOf(app),
                      longer == names.end() ? DidYouMean(flag, names) : absl::StrCat("; did you mean ", *longer, "?"),
                      help);
}

// The innermost subcommand that was given.
const CLI::App& Chosen(const CLI::App& app) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  return chosen.empty() ? app : Chosen(*chosen.front());
}

// Returns the subcommand of this name; null if there is none.
const CLI::App* SubcommandNamed(const CLI::App& app, const std::string& name) {
  for (const CLI::App* sub : app.get_subcommands({})) {
    if (sub->get_name() == name) return sub;
  }
  return nullptr;
}

// Returns the option that a word such as "--a", "--a=1" or "-o" names; null if there is none.
const CLI::Option* OptionOf(const CLI::App& app, const std::string& word) {
  return absl::StartsWith(word, "-") ? app.get_option_no_throw(word.substr(0, word.find('='))) : nullptr;
}

// Returns in words what CLI11 says of an option without its value, or of one that is given more than once.
std::string ValuesInWords(const std::string& what) {
  const std::string missing = ": 1 required ";
  if (const size_t at = what.find(missing); at != std::string::npos && absl::EndsWith(what, " missing")) {
    return absl::StrCat(what.substr(0, at), ": must have a value");
  }
  const std::string more = ": At Most 1 required but received ";
  const size_t at = what.find(more);
  if (at == std::string::npos) return what;
  return absl::StrCat(what.substr(0, at), ": is given ", what.substr(at + more.size()), " times: must be given once");
}

}  // namespace

std::string ValueError(const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App* at = &app;
  for (size_t i = 0; i < words.size() && words[i] != "--"; ++i) {
    const std::string& word = words[i];
    if (const CLI::App* sub = SubcommandNamed(*at, word); sub != nullptr) at = sub;
    const CLI::Option* const option = OptionOf(*at, word);
    if (option == nullptr) continue;
    const size_t equals = word.find('=');
    if (equals == 2) return absl::StrCat(word, ": must be ", word.substr(0, equals), " ", word.substr(equals + 1));
    if (equals + 1 == word.size()) return absl::StrCat(word, ": must have a value");
    const bool takes_next = equals == std::string::npos && option->get_items_expected_min() > 0;
    if (!takes_next || ++i == words.size()) continue;
    // The empty name of a service is that of the whole server, and a column of a table may have none.
    const bool may_be_empty = option->check_name("--service") || option->check_name("--skip-column");
    if (words[i].empty() && !may_be_empty) return absl::StrCat(word, ": must have a value");
    if (!absl::StartsWith(words[i], "--") || OptionOf(*at, words[i]) == nullptr) continue;
    return absl::StrCat(word, ": must have a value, before the option ", words[i]);
  }
  return "";
}

std::string UsageError(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExcludesError)) {
    return absl::StrCat(absl::StrReplaceAll(error.what(), {{" excludes ", " cannot be combined with "}}),
                        ": give one of them");
  }
  const CLI::App& chosen = Chosen(app);
  const std::vector<std::string> extras = app.remaining(/*recurse=*/true);
  const bool lacks_subcommand = !chosen.get_subcommands({}).empty();
  const bool is_extra = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError);
  if (extras.empty() || (!lacks_subcommand && !is_extra)) {
    return lacks_subcommand && extras.empty() ? NoSubcommand(chosen) : ValuesInWords(error.what());
  }
  const std::string& word = extras.front();
  return lacks_subcommand && !absl::StartsWith(word, "-") ? NoSuchSubcommand(chosen, word)
                                                          : NoSuchArgument(chosen, word);
}

}  // namespace ricochet::cli
