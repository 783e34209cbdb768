// LogWriter: writes lines to a descriptor on a thread of its own, so that a log that cannot be written stops nobody.
//
// Lines wait in a buffer of bounded size; a line that finds it full is dropped and counted. A write that fails, because
// the disk is full for example, is tried again every second with nothing lost of what waits. Once lines flow again, a
// line says how many were dropped before it.

#ifndef RICOCHET_SERVER_BASE_LOG_WRITER_H_
#define RICOCHET_SERVER_BASE_LOG_WRITER_H_

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace ricochet::server {

// Thread safety: every method may be called from several threads at once.
class LogWriter {
 public:
  static constexpr size_t kDefaultBufferBytes = size_t{4} << 20;

  // Makes the line that reports a number of dropped lines.
  using Notice = std::function<std::string(int64_t dropped)>;

  // Appends to the file at `path`, which is made if it is not there; an empty path means standard error. At most
  // `buffer_bytes` bytes wait to be written.
  // Errors: those of the file system, and UNAVAILABLE for a pipe that nobody reads; the message names the path.
  static absl::StatusOr<std::unique_ptr<LogWriter>> Open(const std::string& path,
                                                         size_t buffer_bytes = kDefaultBufferBytes);

  // Waits at most a second for lines that are not yet written, then gives them up.
  ~LogWriter();
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  // Sets what makes the line about dropped lines; before, none is written.
  void SetNotice(Notice notice);

  // Takes a line, which must end with a newline, or drops it. Never waits for the descriptor.
  void Push(absl::string_view line);

  // Waits until every line taken is written, at most `time`. Returns true if they are.
  bool Flush(std::chrono::milliseconds time);

  // Opens the path again and closes the old file, for a program that has renamed it. Standard error stays as it is.
  // Errors: as those of Open; lines then go to the old file.
  absl::Status Reopen();

  // Returns the number of lines dropped since the start.
  int64_t dropped() const;

 private:
  struct State;
  explicit LogWriter(std::shared_ptr<State> state);

  // The thread shares the state, because it is left behind if a write never returns.
  const std::shared_ptr<State> state_;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_BASE_LOG_WRITER_H_
