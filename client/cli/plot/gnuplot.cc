#include "client/cli/plot/gnuplot.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <vector>

#include "absl/strings/match.h"
#include "client/cli/io/output.h"
#include "client/cli/terminal/interrupt.h"

namespace ricochet::cli {
namespace {

absl::Status SystemError() { return absl::ErrnoToStatus(errno, "cannot start gnuplot"); }

// A descriptor that is closed at the end.
class Descriptor {
 public:
  explicit Descriptor(int descriptor) : descriptor_(descriptor) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(descriptor_); }
  int get() const { return descriptor_; }

 private:
  int descriptor_;
};

// Reads from a pipe until its writers have closed it. Errors: CANCELLED after Ctrl-C.
absl::StatusOr<std::string> ReadAll(int pipe) {
  constexpr int kBetweenLooksMs = 50;
  std::string text;
  std::array<char, 1 << 16> buffer;
  while (true) {
    pollfd ready = {.fd = pipe, .events = POLLIN, .revents = 0};
    const int found = poll(&ready, 1, kBetweenLooksMs);
    if (Interrupt::Happened()) return absl::CancelledError("interrupted");
    if (found == 0) continue;
    const ssize_t count = read(pipe, buffer.data(), buffer.size());
    if (count > 0) text.append(buffer.data(), static_cast<size_t>(count));
    if (count == 0) return text;
    if (count < 0 && errno != EINTR) return SystemError();
  }
}

// The environment of this process with a UTF-8 locale: in others gnuplot warns of characters that it cannot write.
std::vector<char*> Utf8Environment(std::string& locale) {
  locale = "LC_ALL=C.UTF-8";  // It goes before all other variables of the locale.
  std::vector<char*> variables = {locale.data()};
  for (char** variable = environ; *variable != nullptr; ++variable) {
    if (!absl::StartsWith(*variable, "LC_ALL=")) variables.push_back(*variable);
  }
  variables.push_back(nullptr);
  return variables;
}

// Starts gnuplot with these as its standard input and output, and with no signal blocked or ignored. It gets a process
// group of its own: at Ctrl-C it would read on behind its script. Returns 0 or an errno.
int SpawnGnuplot(int input, int output, pid_t& child) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigemptyset(&none);
  sigset_t ignored = none;  // By main.
  sigaddset(&ignored, SIGPIPE);
  sigaddset(&ignored, SIGXFSZ);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &ignored);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  std::string name = "gnuplot";
  char* const arguments[] = {name.data(), nullptr};
  std::string locale;
  const std::vector<char*> environment = Utf8Environment(locale);
  const int error = posix_spawnp(&child, "gnuplot", &actions, &attributes, arguments, environment.data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return error;
}

}  // namespace

absl::StatusOr<std::string> RunGnuplot(const std::string& script) {
  // A script in memory can be read while gnuplot draws, which a pipe would need a thread for.
  const Descriptor input(memfd_create("gnuplot script", MFD_CLOEXEC));
  if (input.get() < 0) return SystemError();
  if (absl::Status status = WriteAll(input.get(), script); !status.ok()) return status;
  if (lseek(input.get(), 0, SEEK_SET) != 0) return SystemError();
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return SystemError();
  const Descriptor output(ends[0]);
  pid_t child = -1;
  const int error = SpawnGnuplot(input.get(), ends[1], child);
  close(ends[1]);
  if (error == ENOENT) {
    return absl::FailedPreconditionError("pictures need gnuplot, which is not installed (Debian: gnuplot-nox)");
  }
  if (error != 0) return absl::ErrnoToStatus(error, "cannot start gnuplot");
  absl::StatusOr<std::string> picture = ReadAll(output.get());
  if (!picture.ok()) kill(child, SIGKILL);
  int result = 0;
  while (waitpid(child, &result, 0) < 0 && errno == EINTR) {
  }
  if (!picture.ok() || (WIFEXITED(result) && WEXITSTATUS(result) == 0)) return picture;
  return absl::InternalError("gnuplot failed");
}

}  // namespace ricochet::cli
