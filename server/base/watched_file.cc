#include "server/base/watched_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "server/base/descriptor.h"

namespace ricochet::server {
namespace {

constexpr size_t kMostBytes = 1 << 20;

bool IsSame(const struct stat& a, const struct stat& b) {
  const auto same_time = [](const timespec& x, const timespec& y) {
    return x.tv_sec == y.tv_sec && x.tv_nsec == y.tv_nsec;
  };
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino && a.st_size == b.st_size && same_time(a.st_mtim, b.st_mtim) &&
         same_time(a.st_ctim, b.st_ctim);
}

}  // namespace

bool WatchedFile::HasChanged() const {
  struct stat now = {};
  if (stat(path_.c_str(), &now) != 0) return seen_.has_value();
  return !seen_.has_value() || !IsSame(*seen_, now);
}

absl::StatusOr<std::string> WatchedFile::Read() {
  const auto failed = [this] { return absl::ErrnoToStatus(errno, absl::StrCat("cannot read ", path_)); };
  seen_.reset();
  const Descriptor file(open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat now = {};
  // The state is taken before the contents, so that a change in between is noticed the next time.
  if (!file.is_open() || fstat(file.number(), &now) != 0) return failed();
  // A pipe could make the server wait for ever, and gives its contents only once.
  if (!S_ISREG(now.st_mode)) return absl::InvalidArgumentError(absl::StrCat(path_, " is not a regular file"));
  std::string text;
  std::array<char, 4096> part = {};
  for (;;) {
    const ssize_t count = read(file.number(), part.data(), part.size());
    if (count < 0) return failed();
    if (count == 0) break;
    text.append(part.data(), static_cast<size_t>(count));
    if (text.size() > kMostBytes) return absl::InvalidArgumentError(absl::StrCat(path_, " has more than 1 MiB"));
  }
  seen_ = now;
  return text;
}

}  // namespace ricochet::server
