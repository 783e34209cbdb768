#include "client/cli/io/used_files.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <map>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "client/cli/io/output.h"
#include "core/base/try.h"

namespace ricochet::cli {
namespace {

struct Used {
  FileUse use;
  std::string name;  // For errors.
};

// The first use of each file, by its identity.
std::map<std::string, Used>& AllUsed() {
  static auto* const used = new std::map<std::string, Used>;
  return *used;
}

std::string InodeText(const struct stat& info) { return absl::StrCat("inode ", info.st_dev, " ", info.st_ino); }

// Returns an empty text for standard input that is not a file.
std::string IdentityOfStream(FileUse use) {
  struct stat info;
  const int descriptor = use == FileUse::kRead ? STDIN_FILENO : STDOUT_FILENO;
  if (fstat(descriptor, &info) == 0 && S_ISREG(info.st_mode)) return InodeText(info);
  return use == FileUse::kRead ? "" : "standard output";
}

absl::StatusOr<std::string> IdentityOf(FileUse use, const std::string& path) {
  if (path == "-" || (use == FileUse::kWritten && IsStandardOutput(path))) return IdentityOfStream(use);
  if (IsDevice(path)) return "";
  struct stat info;
  const bool exists = stat(path.c_str(), &info) == 0;
  if (use == FileUse::kRead) return exists ? InodeText(info) : path;
  RICOCHET_TRY(std::string target, FileToWrite(path));
  const std::string folder = std::filesystem::path(target).parent_path();
  if (access(folder.c_str(), W_OK | X_OK) != 0) return absl::ErrnoToStatus(errno, absl::StrCat("cannot write ", path));
  return exists ? InodeText(info) : target;
}

}  // namespace

absl::Status UseFile(FileUse use, const std::string& flag, const std::string& path) {
  const std::string name =
      flag.empty() && path == "-" ? "standard output" : absl::StrCat(flag, flag.empty() ? "" : " ", path);
  if (use == FileUse::kRead && path == "-") {
    const auto [first, is_new] = AllUsed().insert({"standard input", {.use = use, .name = name}});
    if (!is_new) {
      return absl::InvalidArgumentError(
          absl::StrCat(first->second.name, " and ", name, " both read standard input: one must name a file"));
    }
  }
  RICOCHET_TRY(const std::string identity, IdentityOf(use, path));
  if (identity.empty()) return absl::OkStatus();
  const auto [first, is_new] = AllUsed().insert({identity, {.use = use, .name = name}});
  const Used& other = first->second;
  if (is_new || (use == FileUse::kRead && other.use == FileUse::kRead)) return absl::OkStatus();
  if (use == other.use) {
    return absl::InvalidArgumentError(absl::StrCat(other.name, " and ", name, " are one file: must be two"));
  }
  const bool is_written = use == FileUse::kWritten;
  return absl::InvalidArgumentError(absl::StrCat(is_written ? name : other.name, " would be written over ",
                                                 is_written ? other.name : name, ": must name another file"));
}

void ForgetUsedFiles() { AllUsed().clear(); }

}  // namespace ricochet::cli
