// ricochet: the command line program.

#include <malloc.h>

#include <CLI/App.hpp>
#include <csignal>
#include <iostream>
#include <memory>

#include "absl/strings/str_cat.h"
#include "absl/synchronization/mutex.h"
#include "client/cli/common.h"
#include "client/cli/exit_code.h"
#include "client/cli/file_option.h"
#include "client/cli/flag_names.h"
#include "client/cli/program.h"
#include "client/cli/usage_error.h"

namespace {

// Makes glibc keep the memory of the chunks of a sweep for the next ones. It would return each to the system, whose pages
// cost as much as the points in them.
void KeepMemoryOfChunks() {
  constexpr int kAboveAnyChunk = 32 << 20;
  mallopt(M_MMAP_THRESHOLD, kAboveAnyChunk);
  mallopt(M_TRIM_THRESHOLD, kAboveAnyChunk);
}

}  // namespace

int main(int argc, char** argv) {
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
  KeepMemoryOfChunks();
  // Ignoring these signals turns a closed pipe and a full quota into errors of write; temporary files are then removed.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  ricochet::cli::Command command;
  const std::unique_ptr<CLI::App> app = ricochet::cli::MakeProgram({argv, argv + argc}, command);
  try {
    app->parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app->exit(error);
    std::cerr << (argc == 1 ? app->help() : absl::StrCat("ricochet: ", ricochet::cli::UsageError(*app, error), "\n"));
    return ricochet::cli::kUsage;
  }
  absl::Status status = ricochet::cli::UseFilesOf(*app);
  if (status.ok()) status = command();
  ricochet::cli::PrintError(ricochet::cli::NameFlags(*app, status));
  return ricochet::cli::ExitCodeOf(status);
}
