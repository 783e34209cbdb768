#include "client/cli/gnuplot.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <vector>

namespace ricochet::cli {
namespace {

// Writes all of `text` to the pipe and closes it. Returns false if the reader went away.
bool Feed(int pipe, const std::string& text) {
  size_t done = 0;
  while (done < text.size()) {
    const ssize_t count = write(pipe, text.data() + done, text.size() - done);
    if (count < 0 && errno != EINTR) break;
    if (count > 0) done += static_cast<size_t>(count);
  }
  close(pipe);
  return done == text.size();
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

// Starts gnuplot with `input` as its standard input and with no signal blocked or ignored. Returns 0 or an errno.
int SpawnGnuplot(int input, pid_t& child) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
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

absl::Status RunGnuplot(const std::string& script) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return absl::ErrnoToStatus(errno, "cannot start gnuplot");
  pid_t child = -1;
  const int error = SpawnGnuplot(ends[0], child);
  close(ends[0]);
  if (error != 0) {
    close(ends[1]);
    if (error != ENOENT) return absl::ErrnoToStatus(error, "cannot start gnuplot");
    return absl::FailedPreconditionError("pictures need gnuplot, which is not installed (Debian: gnuplot-nox)");
  }
  const bool fed = Feed(ends[1], script);
  int result = 0;
  while (waitpid(child, &result, 0) < 0 && errno == EINTR) {
  }
  if (fed && WIFEXITED(result) && WEXITSTATUS(result) == 0) return absl::OkStatus();
  return absl::InternalError("gnuplot failed");
}

}  // namespace ricochet::cli
