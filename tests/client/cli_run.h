// Runs the command line as a user does.

#ifndef RICOCHET_TESTS_CLIENT_CLI_RUN_H_
#define RICOCHET_TESTS_CLIENT_CLI_RUN_H_

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace ricochet::cli {

struct CliResult {
  int exit_code = -1;
  std::string out;
  std::string err;
};

using Arguments = std::vector<std::string>;

// A directory of its own for each test, gone after it, in which the command line runs.
class CliTest : public testing::Test {
 protected:
  CliTest();
  ~CliTest() override;

  // `ricochet arguments...` with `input` as standard input.
  CliResult Run(const Arguments& arguments, const std::string& input = "") const;
  // A shell script, in which "$R" is the path of ricochet.
  CliResult RunShell(const std::string& script, const std::string& input = "") const;

  void Write(const std::string& name, const std::string& text) const;
  std::string Read(const std::string& name) const;
  std::vector<std::string> Files() const;  // Sorted.

 private:
  std::filesystem::path directory_;  // For the test's files.
  std::filesystem::path streams_;    // For the program's standard streams.
};

std::string ReadFile(const std::filesystem::path& path);

}  // namespace ricochet::cli

#endif  // RICOCHET_TESTS_CLIENT_CLI_RUN_H_
