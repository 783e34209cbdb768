#include "client/cli/io/output.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/cord.h"
#include "absl/strings/str_cat.h"
#include "core/base/try.h"

namespace ricochet::cli {
namespace {

constexpr char kReaderGoneUrl[] = "ricochet/reader_gone";

std::atomic<bool (*)()> is_stopped = nullptr;

absl::Status SystemError(const std::string& what) { return absl::ErrnoToStatus(errno, what); }

// Returns how many bytes a pipe or a terminal that has room takes without blocking: an empty pipe as many as it holds.
size_t RoomIn(int descriptor) {
  int queued = 0;
  const int capacity = fcntl(descriptor, F_GETPIPE_SZ);
  const bool is_empty = capacity > 0 && ioctl(descriptor, FIONREAD, &queued) == 0 && queued == 0;
  return is_empty ? static_cast<size_t>(capacity) : PIPE_BUF;
}

// Waits until a write of PIPE_BUF bytes cannot block. Returns false if the run is stopped meanwhile.
bool WaitForRoom(int descriptor) {
  constexpr int kBetweenLooksMs = 50;
  pollfd ready = {.fd = descriptor, .events = POLLOUT, .revents = 0};
  while (poll(&ready, 1, kBetweenLooksMs) == 0) {
    if (bool (*const stopped)() = is_stopped; stopped != nullptr && stopped()) return false;
  }
  return true;
}

// The mode of the file that is replaced, or that of a new one.
mode_t ModeFor(const std::string& path) {
  constexpr mode_t kPermissions = 0777;
  if (struct stat info; stat(path.c_str(), &info) == 0) return info.st_mode & kPermissions;
  const mode_t mask = umask(0);
  umask(mask);
  return 0666 & ~mask;
}

}  // namespace

bool IsStandardOutput(const std::string& path) { return path.empty() || path == "-" || path == "/dev/stdout"; }

void StopWritingWhen(bool (*stopped)()) { is_stopped = stopped; }

absl::Status WriteAll(int descriptor, std::string_view text) {
  struct stat info;
  const bool may_block =
      isatty(descriptor) == 1 || (fstat(descriptor, &info) == 0 && (S_ISFIFO(info.st_mode) || S_ISSOCK(info.st_mode)));
  while (!text.empty()) {
    if (may_block && !WaitForRoom(descriptor)) return absl::CancelledError("interrupted");
    const size_t most = may_block ? RoomIn(descriptor) : text.size();
    const ssize_t count = write(descriptor, text.data(), std::min(text.size(), most));
    if (count >= 0) {
      text.remove_prefix(static_cast<size_t>(count));
    } else if (errno == EPIPE) {
      absl::Status status = absl::CancelledError("the reader of the output has gone");
      status.SetPayload(kReaderGoneUrl, absl::Cord());
      return status;
    } else if (errno != EINTR) {
      return SystemError("cannot write the output");
    }
  }
  return absl::OkStatus();
}

absl::StatusOr<std::string> FileToWrite(const std::string& path) {
  constexpr int kMostLinks = 40;  // Linux follows as many.
  std::error_code failure;
  std::filesystem::path target = path;
  for (int i = 0; i < kMostLinks && std::filesystem::is_symlink(target, failure); ++i) {
    target = target.parent_path() / std::filesystem::read_symlink(target, failure);
  }
  target = std::filesystem::weakly_canonical(std::filesystem::absolute(target, failure), failure);
  if (failure || !target.has_filename() || std::filesystem::is_directory(target, failure)) {
    return absl::FailedPreconditionError(absl::StrCat("cannot write ", path, ": not a file"));
  }
  return target.string();
}

bool IsDevice(const std::string& path) {
  struct stat info;
  return stat(path.c_str(), &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode);
}

absl::StatusOr<AtomicFile> AtomicFile::Create(const std::string& path) {
  RICOCHET_TRY(const std::string written, FileToWrite(path));
  const std::filesystem::path target = written;
  std::string name = absl::StrCat(target.parent_path().string(), "/.", target.filename().string(), ".XXXXXX");
  AtomicFile file;
  file.descriptor_ = mkostemp(name.data(), O_CLOEXEC);
  if (file.descriptor_ < 0) return SystemError(absl::StrCat("cannot write ", path));
  file.path_ = target.string();
  file.temporary_path_ = std::move(name);
  if (fchmod(file.descriptor_, ModeFor(file.path_)) != 0) return SystemError(absl::StrCat("cannot write ", path));
  return file;
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : path_(std::move(other.path_)),
      temporary_path_(std::exchange(other.temporary_path_, "")),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) close(descriptor_);
  if (!temporary_path_.empty()) unlink(temporary_path_.c_str());
}

absl::Status AtomicFile::Commit() {
  if (fsync(descriptor_) != 0) return SystemError(absl::StrCat("cannot write ", path_));
  if (std::rename(temporary_path_.c_str(), path_.c_str()) != 0) {
    return SystemError(absl::StrCat("cannot replace ", path_));
  }
  temporary_path_.clear();
  return absl::OkStatus();
}

absl::StatusOr<Output> Output::Open(const std::string& path) {
  if (IsStandardOutput(path)) return Output(std::nullopt, STDOUT_FILENO, false);
  if (IsDevice(path)) {
    const int descriptor = open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor < 0) return SystemError(absl::StrCat("cannot write ", path));
    return Output(std::nullopt, descriptor, true);
  }
  RICOCHET_TRY(AtomicFile file, AtomicFile::Create(path));
  const int descriptor = file.descriptor();
  return Output(std::move(file), descriptor, false);
}

Output::Output(Output&& other) noexcept
    : file_(std::move(other.file_)), descriptor_(other.descriptor_), owned_(std::exchange(other.owned_, false)) {}

Output::~Output() {
  if (owned_) close(descriptor_);
}

absl::Status Output::Commit() { return file_.has_value() ? file_->Commit() : absl::OkStatus(); }

absl::Status WriteFile(const std::string& path, std::string_view text) {
  RICOCHET_TRY(Output output, Output::Open(path));
  if (absl::Status status = output.Write(text); !status.ok()) return status;
  return output.Commit();
}

bool IsReaderGone(const absl::Status& status) { return status.GetPayload(kReaderGoneUrl).has_value(); }

}  // namespace ricochet::cli
