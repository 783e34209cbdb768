#include "client/cli/io/partial_file.h"

#include <fcntl.h>
#include <google/protobuf/util/json_util.h>
#include <google/protobuf/util/message_differencer.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/cli/io/output.h"
#include "client/cli/io/used_files.h"
#include "core/base/try.h"
#include "proto/wire/crc32c.h"

namespace ricochet::cli {
namespace {

absl::Status SystemError(const std::string& what) { return absl::ErrnoToStatus(errno, what); }

std::string ToJson(const Partial& manifest) {
  google::protobuf::util::JsonPrintOptions options;
  options.add_whitespace = true;
  options.preserve_proto_field_names = true;
  std::string text;
  // A manifest has only fields that JSON can tell.
  static_cast<void>(google::protobuf::util::MessageToJsonString(manifest, &text, options));
  return text;
}

// Opens the file and locks it. A file that another run has renamed meanwhile is not the one that was asked for.
absl::StatusOr<int> OpenLocked(const std::string& path) {
  const int descriptor = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor < 0) return SystemError(absl::StrCat("cannot write ", path));
  struct stat ours;
  struct stat named;
  const bool locked = flock(descriptor, LOCK_EX | LOCK_NB) == 0 && fstat(descriptor, &ours) == 0 &&
                      stat(path.c_str(), &named) == 0 && ours.st_ino == named.st_ino;
  if (locked) return descriptor;
  close(descriptor);
  return absl::FailedPreconditionError(absl::StrCat("another run is writing ", path));
}

int64_t SizeOf(int descriptor) {
  struct stat info;
  return fstat(descriptor, &info) == 0 ? info.st_size : 0;
}

// Leaves what identifies a sweep.
Partial IdentityOf(const Partial& manifest) {
  Partial identity;
  identity.set_format(manifest.format());
  identity.set_grid_fingerprint(manifest.grid_fingerprint());
  identity.set_first_index(manifest.first_index());
  if (manifest.has_end_index()) identity.set_end_index(manifest.end_index());
  return identity;
}

}  // namespace

PartialFile::PartialFile(std::string path, int descriptor)
    : path_(std::move(path)), part_path_(path_ + ".part"), descriptor_(descriptor) {}

PartialFile::PartialFile(PartialFile&& other) noexcept
    : path_(std::move(other.path_)),
      part_path_(std::move(other.part_path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      manifest_(std::move(other.manifest_)),
      bytes_(other.bytes_),
      crc_(other.crc_) {}

PartialFile::~PartialFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

absl::StatusOr<PartialFile> PartialFile::Open(const std::string& path, const Partial& wanted, bool resume) {
  RICOCHET_TRY(std::string target, FileToWrite(path));
  for (const char* ending : {".part", ".part.json", ".part.json.new"}) {
    if (absl::Status status = UseFile(FileUse::kWritten, "", target + ending); !status.ok()) return status;
  }
  RICOCHET_TRY(const int descriptor, OpenLocked(target + ".part"));
  PartialFile file(std::move(target), descriptor);
  const bool has_points = SizeOf(descriptor) > 0;
  if (has_points && !resume) {
    return absl::InvalidArgumentError(absl::StrCat(file.part_path_, " is the first part of an unfinished sweep: add ",
                                                   "--resume to go on with it, or remove it"));
  }
  const bool has_manifest = access(file.manifest_path().c_str(), F_OK) == 0;
  if (has_manifest && !resume) {
    unlink(file.part_path_.c_str());  // It is empty.
    return absl::InvalidArgumentError(absl::StrCat(
        file.manifest_path(), " is there, and the sweep needs this name: remove it, or add --resume if an ",
        "unfinished sweep left it"));
  }
  if (resume && (has_points || has_manifest)) {
    if (absl::Status status = file.Resume(wanted); !status.ok()) return status;
    return file;
  }
  file.manifest_ = IdentityOf(wanted);
  file.manifest_.set_next_index(wanted.first_index());
  if (absl::Status status = file.WriteManifest(); !status.ok()) {
    file.Discard();
    return status;
  }
  return file;
}

absl::Status PartialFile::Resume(const Partial& wanted) {
  std::ostringstream text;
  text << std::ifstream(manifest_path()).rdbuf();
  if (const auto read = google::protobuf::util::JsonStringToMessage(text.str(), &manifest_); !read.ok()) {
    return absl::DataLossError(absl::StrCat("cannot go on with ", part_path_, ": ", manifest_path(),
                                            " is missing or no manifest (", std::string(read.message()), "): remove ",
                                            part_path_, " and begin anew"));
  }
  using google::protobuf::util::MessageDifferencer;
  if (!MessageDifferencer::Equals(IdentityOf(manifest_), IdentityOf(wanted))) {
    return absl::InvalidArgumentError(absl::StrCat(
        part_path_, " is part of another sweep than the one asked for (", IdentityOf(manifest_).ShortDebugString(),
        ", not ", IdentityOf(wanted).ShortDebugString(), "): name another file, or remove it"));
  }
  if (manifest_.bytes() > 0 && SizeOf(descriptor_) == 0) {
    return absl::DataLossError(absl::StrCat(part_path_, " is missing or empty, although ", manifest_path(), " counts ",
                                            manifest_.bytes(), " bytes: remove both to start anew"));
  }
  if (absl::Status status = CheckBytes(); !status.ok()) return status;
  bytes_ = manifest_.bytes();
  crc_ = static_cast<uint32_t>(manifest_.crc32c());
  if (ftruncate(descriptor_, bytes_) != 0 || lseek(descriptor_, bytes_, SEEK_SET) != bytes_) {
    return SystemError(absl::StrCat("cannot write ", part_path_));
  }
  return absl::OkStatus();
}

absl::Status PartialFile::CheckBytes() const {
  std::string buffer(1 << 20, '\0');
  uint32_t crc = 0;
  int64_t left = manifest_.bytes();
  while (left > 0) {
    const ssize_t count = read(descriptor_, buffer.data(), std::min<size_t>(buffer.size(), static_cast<size_t>(left)));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return SystemError(absl::StrCat("cannot read ", part_path_));
    if (count == 0) break;
    crc = ExtendCrc32c(crc, {buffer.data(), static_cast<size_t>(count)});
    left -= count;
  }
  if (left == 0 && crc == manifest_.crc32c()) return absl::OkStatus();
  return absl::DataLossError(absl::StrCat("the first ", manifest_.bytes(), " bytes of ", part_path_,
                                          " are not those that were written: remove it to start anew"));
}

absl::Status PartialFile::Write(std::string_view text) {
  if (absl::Status status = WriteAll(descriptor_, text); !status.ok()) {
    // This gives space back, which the manifest may need. Bytes that stay are cut off by the next run.
    if (ftruncate(descriptor_, bytes_) == 0) lseek(descriptor_, bytes_, SEEK_SET);
    return status;
  }
  bytes_ += static_cast<int64_t>(text.size());
  crc_ = ExtendCrc32c(crc_, text);
  return absl::OkStatus();
}

absl::Status PartialFile::Checkpoint(const Partial& progress) {
  if (fdatasync(descriptor_) != 0) return SystemError(absl::StrCat("cannot write ", part_path_));
  manifest_ = progress;
  manifest_.set_bytes(bytes_);
  manifest_.set_crc32c(crc_);
  return WriteManifest();
}

absl::Status PartialFile::WriteManifest() {
  const std::string next = manifest_path() + ".new";
  const int descriptor = open(next.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) return SystemError(absl::StrCat("cannot write ", next));
  absl::Status status = WriteAll(descriptor, ToJson(manifest_));
  if (status.ok() && fsync(descriptor) != 0) status = SystemError(absl::StrCat("cannot write ", next));
  close(descriptor);
  if (status.ok() && std::rename(next.c_str(), manifest_path().c_str()) != 0) {
    status = SystemError(absl::StrCat("cannot replace ", manifest_path()));
  }
  if (!status.ok()) unlink(next.c_str());
  return status;
}

absl::Status PartialFile::Commit() {
  if (fsync(descriptor_) != 0) return SystemError(absl::StrCat("cannot write ", part_path_));
  if (std::rename(part_path_.c_str(), path_.c_str()) != 0) return SystemError(absl::StrCat("cannot replace ", path_));
  unlink(manifest_path().c_str());
  return absl::OkStatus();
}

void PartialFile::Discard() {
  unlink(part_path_.c_str());
  unlink(manifest_path().c_str());
}

}  // namespace ricochet::cli
