#include "client/cli/plot/gnuplot.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <vector>

#include "client/cli/io/output.h"

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

// Reads from a pipe until its writers have closed it.
absl::StatusOr<std::string> ReadAll(int pipe) {
  std::string text;
  std::array<char, 1 << 16> buffer;
  while (true) {
    const ssize_t count = read(pipe, buffer.data(), buffer.size());
    if (count > 0) text.append(buffer.data(), static_cast<size_t>(count));
    if (count == 0) return text;
    if (count < 0 && errno != EINTR) return SystemError();
  }
}

// The environment of this process with a UTF-8 locale: in others gnuplot warns of characters that it cannot write.
class Utf8Environment {
 public:
  Utf8Environment() {
    for (char** variable = environ; *variable != nullptr; ++variable) {
      const std::string text = *variable;
      if (text.rfind("LC_", 0) != 0 && text.rfind("LANG=", 0) != 0) texts_.push_back(text);
    }
    texts_.emplace_back("LC_ALL=C.UTF-8");
    for (std::string& text : texts_) pointers_.push_back(text.data());
    pointers_.push_back(nullptr);
  }
  char* const* get() const { return pointers_.data(); }

 private:
  std::vector<std::string> texts_;
  std::vector<char*> pointers_;
};

// Starts gnuplot with these as its standard input and output, and with no signal blocked or ignored. Returns 0 or an
// errno.
int SpawnGnuplot(int input, int output, pid_t& child) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigemptyset(&none);
  sigset_t broken_pipe = none;
  sigaddset(&broken_pipe, SIGPIPE);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &broken_pipe);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  std::string name = "gnuplot";
  char* const arguments[] = {name.data(), nullptr};
  const Utf8Environment environment;
  const int error = posix_spawnp(&child, "gnuplot", &actions, &attributes, arguments, environment.get());
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
  int result = 0;
  while (waitpid(child, &result, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(result) && WEXITSTATUS(result) == 0) return picture;
  return absl::InternalError("gnuplot failed");
}

}  // namespace ricochet::cli
