// CliTest: runs the command line as a user does.

#ifndef RICOCHET_TESTS_CLIENT_CLI_CLI_RUN_H_
#define RICOCHET_TESTS_CLIENT_CLI_CLI_RUN_H_

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/processes/temporary_directory.h"

namespace ricochet::cli {

struct CliResult {
  int exit_code = -1;
  std::string out;
  std::string err;
};

using Arguments = std::vector<std::string>;

// Each test runs the command line in a directory of its own, which is removed after the test.
class CliTest : public testing::Test {
 protected:
  // Runs `ricochet arguments...` with `input` as standard input.
  CliResult Run(const Arguments& arguments, const std::string& input = "") const;
  // Runs a shell script, in which "$R" is the path of ricochet.
  CliResult RunShell(const std::string& script, const std::string& input = "") const;

  void Write(const std::string& name, const std::string& text) const;
  std::string Read(const std::string& name) const;
  std::vector<std::string> Files() const;  // The names of all files in the directory, sorted.

 private:
  TemporaryDirectory directory_;  // Holds the test's files.
  TemporaryDirectory streams_;    // Holds the program's standard streams.
};

std::string ReadFile(const std::filesystem::path& path);

}  // namespace ricochet::cli

#endif  // RICOCHET_TESTS_CLIENT_CLI_CLI_RUN_H_
