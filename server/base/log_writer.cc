#include "server/base/log_writer.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/base/try.h"
#include "server/base/descriptor.h"

namespace ricochet::server {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kBetweenRetries(1000);
constexpr milliseconds kLongestPoll(100);
constexpr milliseconds kTimeToEnd(1000);

// A pipe that poll calls writable takes this number of bytes without blocking.
constexpr size_t kPipePiece = PIPE_BUF;
constexpr size_t kFilePiece = size_t{64} << 10;

// Returns true if standard error is closed, or was at the start and its number belongs to an event of a library now.
bool HasNoStandardError() {
  struct stat status = {};
  return fstat(STDERR_FILENO, &status) != 0 || (status.st_mode & S_IFMT) == 0;
}

int OpenStandardError() {
  return HasNoStandardError() ? open("/dev/null", O_WRONLY | O_CLOEXEC)
                              : fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
}

absl::StatusOr<Descriptor> OpenPath(const std::string& path) {
  // Nonblocking, because opening a pipe that nobody reads would wait for a reader.
  constexpr int kFlags = O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC | O_NOCTTY | O_NONBLOCK;
  Descriptor file(path.empty() ? OpenStandardError() : open(path.c_str(), kFlags, 0640));
  if (file.is_open()) return file;
  const std::string name = path.empty() ? "standard error" : path;
  if (errno == ENXIO)
    return absl::UnavailableError(absl::StrCat("cannot write the log to ", name, ": nobody reads it"));
  return absl::ErrnoToStatus(errno, absl::StrCat("cannot write the log to ", name));
}

size_t PieceFor(int fd) {
  struct stat status = {};
  return fstat(fd, &status) == 0 && S_ISREG(status.st_mode) ? kFilePiece : kPipePiece;
}

// Returns where the piece that starts at `begin` ends: after the last whole line within `most` bytes if there is one.
size_t PieceEnd(const std::string& lines, size_t begin, size_t most) {
  if (lines.size() - begin <= most) return lines.size();
  const size_t newline = lines.rfind('\n', begin + most - 1);
  return newline == std::string::npos || newline < begin ? begin + most : newline + 1;
}

// Returns where the line that contains the byte at `position` starts.
size_t LineStart(const std::string& lines, size_t position) {
  if (position == 0) return 0;
  const size_t newline = lines.rfind('\n', position - 1);
  return newline == std::string::npos ? 0 : newline + 1;
}

// Writes a piece and returns the number of bytes written: 0 if the descriptor does not take any soon, negative after an
// error.
ssize_t WriteSome(int fd, const char* data, size_t size) {
  pollfd ready = {.fd = fd, .events = POLLOUT};
  if (poll(&ready, 1, static_cast<int>(kLongestPoll.count())) <= 0) return 0;
  const ssize_t written = write(fd, data, size);
  return written < 0 && (errno == EAGAIN || errno == EINTR) ? 0 : written;
}

}  // namespace

struct LogWriter::State {
  State(std::string to, Descriptor opened, size_t bytes)
      : path(std::move(to)), buffer_bytes(bytes), file(std::move(opened)) {}

  // Only the thread of the writer calls these; Run returns once it has set `ended`.
  void Run();
  bool Take(std::string& batch);
  void WriteAll(const std::string& batch);
  void TakeReopened(const std::string& batch, size_t& done);
  void WaitForRetry();

  const std::string path;
  const size_t buffer_bytes;
  Descriptor file;  // Only the thread uses it.

  std::mutex mutex;
  std::condition_variable changed;
  std::string waiting;       // Lines that the thread has not taken.
  size_t being_written = 0;  // Bytes that it has taken and not finished.
  int64_t dropped = 0;
  int64_t reported = 0;  // Dropped lines that a notice has told of.
  Notice notice;
  Descriptor reopened;  // Replaces `file` if it is open.
  bool stopping = false;
  bool ended = false;
};

// Moves the waiting lines into `batch`, with the notice of lines that were dropped after them. Returns false once the
// writer stops.
bool LogWriter::State::Take(std::string& batch) {
  std::unique_lock lock(mutex);
  batch.clear();
  being_written = 0;
  changed.notify_all();
  const auto unreported = [this] { return notice && dropped > reported; };
  changed.wait(lock, [&] { return stopping || !waiting.empty() || reopened.is_open() || unreported(); });
  if (stopping) return false;
  if (unreported()) {
    waiting += notice(dropped - reported);
    reported = dropped;
  }
  batch.swap(waiting);
  being_written = batch.size();
  return true;
}

// Goes on with the file that Reopen has opened, with the line at `done` from its start.
void LogWriter::State::TakeReopened(const std::string& batch, size_t& done) {
  const std::lock_guard lock(mutex);
  if (!reopened.is_open()) return;
  file = std::exchange(reopened, Descriptor());
  done = LineStart(batch, done);
}

void LogWriter::State::WaitForRetry() {
  std::unique_lock lock(mutex);
  changed.wait_for(lock, kBetweenRetries, [this] { return stopping || reopened.is_open(); });
}

void LogWriter::State::WriteAll(const std::string& batch) {
  for (size_t done = 0;;) {
    TakeReopened(batch, done);
    if (done == batch.size()) return;
    const size_t end = PieceEnd(batch, done, PieceFor(file.number()));
    const ssize_t written = WriteSome(file.number(), batch.data() + done, end - done);
    if (written < 0) {
      WaitForRetry();
    } else {
      done += static_cast<size_t>(written);
    }
    const std::lock_guard lock(mutex);
    if (stopping) return;
  }
}

void LogWriter::State::Run() {
  std::string batch;
  while (Take(batch)) WriteAll(batch);
  const std::lock_guard lock(mutex);
  ended = true;
  changed.notify_all();
}

absl::StatusOr<std::unique_ptr<LogWriter>> LogWriter::Open(const std::string& path, size_t buffer_bytes) {
  RICOCHET_TRY(auto file, OpenPath(path));
  return std::unique_ptr<LogWriter>(new LogWriter(std::make_shared<State>(path, std::move(file), buffer_bytes)));
}

LogWriter::LogWriter(std::shared_ptr<State> state) : state_(std::move(state)) {
  std::thread([shared = state_] { shared->Run(); }).detach();
}

LogWriter::~LogWriter() {
  Flush(kTimeToEnd);
  std::unique_lock lock(state_->mutex);
  state_->stopping = true;
  state_->changed.notify_all();
  state_->changed.wait_for(lock, kTimeToEnd, [this] { return state_->ended; });
}

void LogWriter::SetNotice(Notice notice) {
  const std::lock_guard lock(state_->mutex);
  state_->notice = std::move(notice);
}

void LogWriter::Push(absl::string_view line) {
  bool first = false;
  {
    const std::lock_guard lock(state_->mutex);
    if (state_->waiting.size() + state_->being_written + line.size() > state_->buffer_bytes) {
      ++state_->dropped;
      return;
    }
    first = state_->waiting.empty();
    state_->waiting.append(line.data(), line.size());
  }
  if (first) state_->changed.notify_all();
}

bool LogWriter::Flush(milliseconds time) {
  std::unique_lock lock(state_->mutex);
  return state_->changed.wait_for(lock, time, [this] {
    const bool all_reported = !state_->notice || state_->dropped == state_->reported;
    return state_->waiting.empty() && state_->being_written == 0 && all_reported;
  });
}

absl::Status LogWriter::Reopen() {
  if (state_->path.empty()) return absl::OkStatus();
  RICOCHET_TRY(auto file, OpenPath(state_->path));
  const std::lock_guard lock(state_->mutex);
  state_->reopened = std::move(file);
  state_->changed.notify_all();
  return absl::OkStatus();
}

int64_t LogWriter::dropped() const {
  const std::lock_guard lock(state_->mutex);
  return state_->dropped;
}

}  // namespace ricochet::server
