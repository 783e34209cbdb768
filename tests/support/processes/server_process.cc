#include "tests/support/processes/server_process.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>

namespace ricochet {
namespace {

using std::chrono::steady_clock;

// Between fork and exec only functions are called that are safe in the child of a process with threads.
[[noreturn]] void Exec(char* const* arguments, const char* output) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int descriptor = open(output, O_WRONLY | O_CREAT | O_TRUNC | O_APPEND, 0600);
  dup2(descriptor, STDOUT_FILENO);
  dup2(descriptor, STDERR_FILENO);
  execv(arguments[0], arguments);
  _exit(127);
}

pid_t Spawn(std::vector<std::string> command, const std::string& output) {
  std::vector<char*> arguments;
  for (std::string& argument : command) arguments.push_back(argument.data());
  arguments.push_back(nullptr);
  const pid_t pid = fork();
  if (pid == 0) Exec(arguments.data(), output.c_str());
  if (pid < 0) throw std::system_error(errno, std::generic_category(), "fork");
  return pid;
}

int ExitStatus(int wait_status) { return WIFEXITED(wait_status) ? WEXITSTATUS(wait_status) : -WTERMSIG(wait_status); }

std::string ReadFile(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// Polls `condition` until it holds or `time` is over; returns whether it held.
template <typename Condition>
bool WaitUntil(std::chrono::seconds time, Condition condition) {
  const auto end = steady_clock::now() + time;
  while (!condition()) {
    if (steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

std::vector<std::string> ServerCommand(const std::vector<std::string>& arguments,
                                       const std::filesystem::path& port_file) {
  std::vector<std::string> command = {RICOCHETD_PATH, "--port-file", port_file};
  // An idle client does not notice the drain at once, and a test need not wait for it.
  const std::pair<std::string, std::string> defaults[] = {
      {"--listen", "127.0.0.1:0"}, {"--drain-grace", "0"}, {"--drain-timeout", "1"}};
  for (const auto& [flag, value] : defaults) {
    if (std::find(arguments.begin(), arguments.end(), flag) == arguments.end()) {
      command.insert(command.end(), {flag, value});
    }
  }
  command.insert(command.end(), arguments.begin(), arguments.end());
  return command;
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& command) : pid_(Spawn(command, directory_ / "output")) {}

ChildProcess::~ChildProcess() {
  if (!ended_) {
    Signal(SIGKILL);
    Wait();
  }
}

void ChildProcess::Signal(int signal) const {
  if (!ended_) kill(pid_, signal);
}

int ChildProcess::Wait() {
  int status = 0;
  while (!ended_ && waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  if (!ended_) exit_status_ = ExitStatus(status);
  ended_ = true;
  return exit_status_;
}

bool ChildProcess::running() {
  int status = 0;
  if (!ended_ && waitpid(pid_, &status, WNOHANG) == pid_) {
    ended_ = true;
    exit_status_ = ExitStatus(status);
  }
  return !ended_;
}

std::string ChildProcess::output() const { return ReadFile(directory_ / "output"); }

std::string ServerPath() { return RICOCHETD_PATH; }

ServerProcess::ServerProcess(const std::vector<std::string>& arguments)
    : port_file_(directory_ / "port"), process_(ServerCommand(arguments, port_file_)) {
  WaitUntil(std::chrono::seconds(20), [this] { return std::filesystem::exists(port_file_) || !process_.running(); });
  std::ifstream(port_file_) >> port_;
  if (port_ == 0) throw std::runtime_error("ricochetd does not take calls:\n" + log());
}

void ServerProcess::Terminate() const { process_.Signal(SIGTERM); }

int ServerProcess::Stop() {
  Terminate();
  return Wait();
}

std::string ServerProcess::LoggedAddress(const std::string& event) const {
  const std::string text = log();
  const std::string before = " " + event + " address=";
  const size_t start = text.find(before);
  if (start == std::string::npos) return "";
  return text.substr(start + before.size(), text.find('\n', start) - start - before.size());
}

std::string ServerProcess::WaitForLog(const std::string& text) const {
  std::string found;
  WaitUntil(std::chrono::seconds(10), [&] {
    found = log();
    return found.find(text) != std::string::npos;
  });
  return found;
}

Ending RunServerToEnd(const std::vector<std::string>& arguments) {
  std::vector<std::string> command = {RICOCHETD_PATH};
  command.insert(command.end(), arguments.begin(), arguments.end());
  ChildProcess process(command);
  const bool ended = WaitUntil(std::chrono::seconds(20), [&process] { return !process.running(); });
  if (!ended) process.Signal(SIGKILL);
  const int exit_status = process.Wait();
  return {.exit_status = exit_status, .output = process.output()};
}

}  // namespace ricochet
