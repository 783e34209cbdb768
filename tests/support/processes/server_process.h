// ServerProcess: a real ricochetd on a free loopback port, for tests and benchmarks.

#ifndef RICOCHET_TESTS_SUPPORT_PROCESSES_SERVER_PROCESS_H_
#define RICOCHET_TESTS_SUPPORT_PROCESSES_SERVER_PROCESS_H_

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/processes/temporary_directory.h"

namespace ricochet {

// A ChildProcess runs a program in a directory of its own, with its output in a file there. Both end with this object.
class ChildProcess {
 public:
  explicit ChildProcess(const std::vector<std::string>& command);
  ~ChildProcess();  // Kills the program if it still runs.
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t pid() const { return pid_; }
  void Signal(int signal) const;

  // Waits for the end of the program, and returns its exit status, or minus the signal that killed it.
  int Wait();

  // True if the program still runs.
  bool running();

  // The standard output and error so far.
  std::string output() const;

 private:
  TemporaryDirectory directory_;
  pid_t pid_ = -1;
  bool ended_ = false;
  int exit_status_ = 0;
};

// Returns the path of the ricochetd that the tests run.
std::string ServerPath();

class ServerProcess {
 public:
  // Starts ricochetd with `arguments` besides --port-file, and waits until it takes calls. Unless `arguments` set them,
  // it listens on a free port of 127.0.0.1, the drain grace is 0 and the drain timeout 1 s. Throws std::runtime_error
  // with the log if ricochetd does not start within 20 s.
  explicit ServerProcess(const std::vector<std::string>& arguments = {});

  // "127.0.0.1:PORT".
  std::string address() const { return "127.0.0.1:" + std::to_string(port_); }
  int port() const { return port_; }
  pid_t pid() const { return process_.pid(); }

  // Sends a signal and returns at once.
  void Signal(int signal) const { process_.Signal(signal); }

  // Sends SIGTERM and returns at once.
  void Terminate() const;

  // Waits for the end of ricochetd, and returns its exit status, or minus the signal that killed it.
  int Wait() { return process_.Wait(); }

  // Calls Terminate and then Wait.
  int Stop();

  std::string log() const { return process_.output(); }

  // Returns the address at which the log says that the server serves `event`, or an empty text.
  std::string LoggedAddress(const std::string& event) const;

  // Waits until the log contains `text`, at most 10 s, and returns the log.
  std::string WaitForLog(const std::string& text) const;

 private:
  TemporaryDirectory directory_;  // Holds the file in which ricochetd writes its port.
  std::filesystem::path port_file_;
  ChildProcess process_;
  int port_ = 0;
};

// The exit status and output of a ricochetd that has ended by itself.
struct Ending {
  int exit_status = 0;
  std::string output;
};

// Runs ricochetd with exactly `arguments` to its end, and kills it after 20 s.
Ending RunServerToEnd(const std::vector<std::string>& arguments);

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_PROCESSES_SERVER_PROCESS_H_
