// WatchedFile: a file whose contents are read again when it has been replaced or changed.

#ifndef RICOCHET_SERVER_BASE_WATCHED_FILE_H_
#define RICOCHET_SERVER_BASE_WATCHED_FILE_H_

#include <sys/stat.h>

#include <optional>
#include <string>

#include "absl/status/statusor.h"

namespace ricochet::server {

// Thread safety: for one thread at a time.
class WatchedFile {
 public:
  explicit WatchedFile(std::string path) : path_(std::move(path)) {}

  const std::string& path() const { return path_; }

  // Returns true if the file is another one than Read has read last, or has changed since.
  bool HasChanged() const;

  // Returns the contents. Errors: those of the file system, and INVALID_ARGUMENT above 1 MiB; the message names the
  // path.
  absl::StatusOr<std::string> Read();

 private:
  std::string path_;
  std::optional<struct stat> seen_;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_BASE_WATCHED_FILE_H_
