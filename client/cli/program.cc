#include "client/cli/program.h"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/cli/text/help_format.h"
#include "ricochet/engine_info.h"

namespace ricochet::cli {

std::unique_ptr<CLI::App> MakeProgram(std::vector<std::string> arguments, Command& command) {
  auto app = std::make_unique<CLI::App>(
      "Computes what happens when something hits a surface with friction. Units are SI and radians.", "ricochet");
  // Subcommands take over the format that is set before them.
  app->formatter(std::make_shared<HelpFormat>());
  app->set_version_flag("-V,--version", [] {
    return absl::StrCat("ricochet ", ThisEngine().version, ", engine ", ThisEngine().fingerprint);
  });
  app->require_subcommand(1);
  AddSolve(*app, command);
  AddBounds(*app, command);
  AddMultiContact(*app, command);
  AddSweep(*app, std::move(arguments), command);
  AddMerge(*app, command);
  AddPlot(*app, command);
  AddAudit(*app, command);
  AddFit(*app, command);
  AddScene(*app, command);
  AddConformance(*app, command);
  AddCost(*app, command);
  AddExplore(*app, command);
  AddInfo(*app, command);
  AddHealth(*app, command);
  app->footer(
      "ricochet SUBCOMMAND --help shows a worked example.\n"
      "Exit codes: 0 done, 2 wrong input, 42 failed, 75 try again, 130 interrupted.");
  return app;
}

std::vector<std::string> WithHelpAsFlag(std::vector<std::string> words) {
  if (words.empty()) return words;
  if (words.front() == "version") words.front() = "--version";
  if (words.front() == "help") {
    words.erase(words.begin());
    words.emplace_back("--help");
  }
  return words;
}

}  // namespace ricochet::cli
