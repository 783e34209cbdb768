// Output: the destination of results, which is standard output or a file that appears complete or not at all.

#ifndef RICOCHET_CLIENT_CLI_IO_OUTPUT_H_
#define RICOCHET_CLIENT_CLI_IO_OUTPUT_H_

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace ricochet::cli {

// True for "-", for nothing, and for the name that Linux gives standard output.
bool IsStandardOutput(const std::string& path);

// Makes WriteAll give up, with CANCELLED, where the reader of a pipe stands still and `stopped()` is true.
void StopWritingWhen(bool (*stopped)());

// Writes all of `text`. Errors: one for which IsReaderGone holds if the reader has closed a pipe; else those of the
// system.
absl::Status WriteAll(int descriptor, std::string_view text);

// Returns the file that writing to `path` replaces: the target of a symbolic link, which need not be there yet, so that
// the link is kept.
// Errors: FAILED_PRECONDITION if it cannot be a file.
absl::StatusOr<std::string> FileToWrite(const std::string& path);

// True if `path` is a device, a pipe or a socket, which is written to directly.
bool IsDevice(const std::string& path);

// A file that is written beside `path` under a temporary name and then renamed, so that a reader never sees a part of
// it.
class AtomicFile {
 public:
  // Errors: PERMISSION_DENIED, NOT_FOUND and so on; the message names the path.
  static absl::StatusOr<AtomicFile> Create(const std::string& path);

  AtomicFile(AtomicFile&& other) noexcept;
  // Removes the temporary file unless it was committed.
  ~AtomicFile();

  int descriptor() const { return descriptor_; }
  const std::string& temporary_path() const { return temporary_path_; }

  // Writes the data to disk and renames the file. Call it once, after the last write. Errors: those of the system.
  absl::Status Commit();

 private:
  AtomicFile() = default;
  std::string path_;
  std::string temporary_path_;  // Empty if there is no file to remove.
  int descriptor_ = -1;
};

// Standard output for an empty path or "-"; a device or pipe at `path`, which is written to directly; else an
// AtomicFile.
class Output {
 public:
  static absl::StatusOr<Output> Open(const std::string& path);

  Output(Output&& other) noexcept;
  Output& operator=(Output&&) = delete;
  ~Output();

  // Errors: those of WriteAll.
  absl::Status Write(std::string_view text) { return WriteAll(descriptor_, text); }
  // Makes a file appear under its name. Call it once, after the last Write. Errors: those of the system.
  absl::Status Commit();

 private:
  Output(std::optional<AtomicFile> file, int descriptor, bool owned)
      : file_(std::move(file)), descriptor_(descriptor), owned_(owned) {}
  std::optional<AtomicFile> file_;
  int descriptor_;
  bool owned_;  // True if the destructor closes `descriptor_`.
};

// Writes all of `text` to what Output::Open opens. Errors: those of Output.
absl::Status WriteFile(const std::string& path, std::string_view text);

// Returns true if the error means that the reader of standard output has gone, as with `| head`. Such a run stops
// without a complaint.
bool IsReaderGone(const absl::Status& status);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_IO_OUTPUT_H_
