// Where results go: standard output, or a file that appears whole or not at all.

#ifndef RICOCHET_CLIENT_CLI_OUTPUT_H_
#define RICOCHET_CLIENT_CLI_OUTPUT_H_

#include <string>

#include "absl/status/statusor.h"

namespace ricochet::cli {

// A file that is written beside `path` under another name and takes its place in one step.
class AtomicFile {
 public:
  // Errors: PERMISSION_DENIED, NOT_FOUND and so on, naming the path.
  static absl::StatusOr<AtomicFile> Create(const std::string& path);

  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&& other) noexcept;
  // Removes the temporary file unless it was committed.
  ~AtomicFile();

  int descriptor() const { return descriptor_; }
  const std::string& temporary_path() const { return temporary_path_; }

  // Flushes to disk and renames. Call it once, last.
  absl::Status Commit();

 private:
  AtomicFile() = default;
  std::string path_;
  std::string temporary_path_;  // Empty once there is nothing to remove.
  int descriptor_ = -1;
};

// Standard output for an empty path; a device or pipe at `path` is written to in place; else an AtomicFile.
class Output {
 public:
  static absl::StatusOr<Output> Open(const std::string& path);

  Output(Output&& other) noexcept;
  Output& operator=(Output&&) = delete;
  ~Output();

  // Errors: IsReaderGone if whoever read standard output has closed it, else those of the system.
  absl::Status Write(const std::string& text);
  // What was written now stands under its name.
  absl::Status Commit();

 private:
  explicit Output(absl::StatusOr<AtomicFile> file, int descriptor, bool owned)
      : file_(std::move(file)), descriptor_(descriptor), owned_(owned) {}
  absl::StatusOr<AtomicFile> file_;  // Not OK where there is none.
  int descriptor_;
  bool owned_;  // Whether `descriptor_` is to be closed here.
};

// Whether the reader of standard output has gone, as under `| head`: a reason to stop, not to complain.
bool IsReaderGone(const absl::Status& status);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_OUTPUT_H_
