// ricochet: the command line program.

#include <fcntl.h>
#include <malloc.h>
#include <unistd.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <csignal>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/synchronization/mutex.h"
#include "client/cli/input/command_options.h"
#include "client/cli/input/file_option.h"
#include "client/cli/input/flag_names.h"
#include "client/cli/io/output.h"
#include "client/cli/program.h"
#include "client/cli/terminal/exit_code.h"
#include "client/cli/terminal/grpc_log.h"
#include "client/cli/terminal/interrupt.h"
#include "client/cli/text/number_input.h"
#include "client/cli/text/usage_error.h"

namespace {

// Makes glibc keep the memory of the chunks of a sweep for the next ones. It would return each to the system, whose
// pages cost as much as the points in them.
void KeepMemoryOfChunks() {
  constexpr int kAboveAnyChunk = 32 << 20;
  mallopt(M_MMAP_THRESHOLD, kAboveAnyChunk);
  mallopt(M_TRIM_THRESHOLD, kAboveAnyChunk);
}

// Opens what is closed of standard input, output and error, so that no file gets their numbers and what is written
// there. Reading from it or writing to it still fails.
void ReserveStandardDescriptors() {
  for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    // open() takes the lowest free number, which is this one.
    if (fcntl(number, F_GETFD) < 0) open("/dev/null", number == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  }
}

}  // namespace

int main(int argc, char** argv) {
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
  ReserveStandardDescriptors();
  KeepMemoryOfChunks();
  ricochet::cli::QuietGrpc();
  // Ignoring these signals turns a closed pipe and a full quota into errors of write; temporary files are then removed.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  ricochet::cli::Interrupt::EndAtSignals();
  ricochet::cli::Command command;
  const std::unique_ptr<CLI::App> app = ricochet::cli::MakeProgram({argv, argv + argc}, command);
  std::vector<std::string> words = ricochet::cli::WithHelpAsFlag({argv + 1, argv + argc});
  if (const std::string wrong = ricochet::cli::ValueError(*app, words); !wrong.empty()) {
    std::cerr << "ricochet: " << wrong << "\n";
    return ricochet::cli::kUsage;
  }
  std::reverse(words.begin(), words.end());  // CLI11 takes them from the end.
  try {
    app->parse(std::move(words));
  } catch (const CLI::ParseError& error) {
    // Help about a subcommand that does not exist is an error.
    const bool is_answer = !app->get_subcommands().empty() || app->remaining().empty();
    if (error.get_exit_code() == 0 && is_answer) {
      std::ostringstream help;
      app->exit(error, help);
      const absl::Status written = ricochet::cli::WriteFile("-", help.str());
      ricochet::cli::PrintError(written);
      return ricochet::cli::ExitCodeOf(written);
    }
    std::cerr << (argc == 1 ? app->help() : absl::StrCat("ricochet: ", ricochet::cli::UsageError(*app, error), "\n"));
    return ricochet::cli::kUsage;
  }
  absl::Status status = ricochet::cli::UseFilesOf(*app);
  if (status.ok()) status = ricochet::cli::WithTlsAlert(command());
  if (const std::string& angle = ricochet::cli::LargeAngleRead(); status.ok() && !angle.empty()) {
    std::cerr << "ricochet: the angle " << angle << " lies beyond a full turn in radians; write " << angle
              << "deg if it is in degrees\n";
  }
  ricochet::cli::PrintError(ricochet::cli::NameFlags(*app, status));
  return ricochet::cli::ExitCodeOf(status);
}
