#include "tests/client/cli/cli_run.h"

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace ricochet::cli {
namespace {

std::string Quoted(const std::string& argument) {
  std::string quoted = "'";
  for (const char c : argument) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

void WriteFile(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

}  // namespace

std::string ReadFile(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

CliResult CliTest::RunShell(const std::string& script, const std::string& input) const {
  WriteFile(streams_ / "in", input);
  WriteFile(streams_ / "script",
            "R=" + Quoted(RICOCHET_PATH) + "\ncd " + Quoted(directory_.path()) + "\n" + script + "\n");
  const std::string command = "sh " + Quoted(streams_ / "script") + " <" + Quoted(streams_ / "in") + " >" +
                              Quoted(streams_ / "out") + " 2>" + Quoted(streams_ / "err");
  const int status = std::system(command.c_str());
  return {.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1,
          .out = ReadFile(streams_ / "out"),
          .err = ReadFile(streams_ / "err")};
}

CliResult CliTest::Run(const Arguments& arguments, const std::string& input) const {
  std::string script = "exec \"$R\"";
  for (const std::string& argument : arguments) script += " " + Quoted(argument);
  return RunShell(script, input);
}

void CliTest::Write(const std::string& name, const std::string& text) const { WriteFile(directory_ / name, text); }

std::string CliTest::Read(const std::string& name) const { return ReadFile(directory_ / name); }

std::vector<std::string> CliTest::Files() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(directory_.path()))
    names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace ricochet::cli
