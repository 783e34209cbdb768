#include "server/base/port_file.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <fstream>

#include "absl/strings/str_cat.h"

namespace ricochet::server {
namespace {

// False if the path is that of something other than a plain file; a symbolic link is not followed.
bool IsFree(const std::string& path) {
  struct stat status = {};
  return lstat(path.c_str(), &status) != 0 || S_ISREG(status.st_mode);
}

}  // namespace

absl::Status WritePortFile(const std::string& path, int port) {
  if (!IsFree(path)) {
    return absl::FailedPreconditionError(absl::StrCat("cannot write ", path, ": it is there and not a plain file"));
  }
  const std::string temporary = absl::StrCat(path, ".", getpid(), ".tmp");
  errno = 0;
  std::ofstream file(temporary);
  file << port << '\n';
  file.close();
  if (file.good() && std::rename(temporary.c_str(), path.c_str()) == 0) return absl::OkStatus();
  absl::Status status = absl::ErrnoToStatus(errno, absl::StrCat("cannot write ", path));
  std::remove(temporary.c_str());
  return status;
}

void RemovePortFile(const std::string& path, int port) {
  int written = 0;
  if (IsFree(path) && std::ifstream(path) >> written && written == port) std::remove(path.c_str());
}

}  // namespace ricochet::server
