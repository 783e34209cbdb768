// ricochet: the command line program.

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <csignal>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/synchronization/mutex.h"
#include "client/cli/audit.h"
#include "client/cli/bounds.h"
#include "client/cli/common.h"
#include "client/cli/cost.h"
#include "client/cli/exit_code.h"
#include "client/cli/health.h"
#include "client/cli/info.h"
#include "client/cli/merge.h"
#include "client/cli/solve.h"
#include "client/cli/sweep.h"
#include "client/cli/usage_error.h"
#include "core/engine/engine.h"

namespace {

using ricochet::ThisEngine;

void AddSubcommands(CLI::App& app, std::vector<std::string> arguments, ricochet::cli::Command& command) {
  app.set_version_flag("--version", [] {
    return absl::StrCat("ricochet ", ThisEngine().version, ", engine ", ThisEngine().fingerprint);
  });
  app.require_subcommand(1);
  ricochet::cli::AddSolve(app, command);
  ricochet::cli::AddBounds(app, command);
  ricochet::cli::AddSweep(app, std::move(arguments), command);
  ricochet::cli::AddMerge(app, command);
  ricochet::cli::AddAudit(app, command);
  ricochet::cli::AddCost(app, command);
  ricochet::cli::AddInfo(app, command);
  ricochet::cli::AddHealth(app, command);
  app.footer(
      "ricochet SUBCOMMAND --help shows a worked example.\n"
      "Exit codes: 0 done, 2 wrong input, 42 failed, 75 try again, 130 interrupted.");
}

}  // namespace

int main(int argc, char** argv) {
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
  // Ignoring these signals turns a closed pipe and a full quota into errors of write; temporary files are then removed.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  CLI::App app("Computes what happens when something hits a surface with friction. Units are SI and radians.",
               "ricochet");
  ricochet::cli::Command command;
  AddSubcommands(app, {argv, argv + argc}, command);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    std::cerr << (argc == 1 ? app.help() : absl::StrCat("ricochet: ", ricochet::cli::UsageError(app, error), "\n"));
    return ricochet::cli::kUsage;
  }
  const absl::Status status = command();
  ricochet::cli::PrintError(status);
  return ricochet::cli::ExitCodeOf(status);
}
