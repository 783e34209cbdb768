// PartialFile: the unfinished output of a sweep, FILE.part, with its manifest FILE.part.json. Both outlive the run that
// writes them, whatever ends it, so that another run can go on.

#ifndef RICOCHET_CLIENT_CLI_IO_PARTIAL_FILE_H_
#define RICOCHET_CLIENT_CLI_IO_PARTIAL_FILE_H_

#include <cstdint>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "ricochet/cli/partial.pb.h"

namespace ricochet::cli {

// A lock keeps a second run from the same file.
class PartialFile {
 public:
  // Starts FILE.part anew, or goes on with it if `resume`. `wanted` has the identity of the sweep: format, fingerprint
  // and range. Whatever FILE.part has beyond its manifest is cut off. Errors: INVALID_ARGUMENT if there is an
  // unfinished file and not `resume`, or if it is of another sweep; DATA_LOSS if its bytes are not those of its
  // manifest; FAILED_PRECONDITION if another run writes it; those of the system.
  static absl::StatusOr<PartialFile> Open(const std::string& path, const Partial& wanted, bool resume);

  PartialFile(PartialFile&& other) noexcept;
  PartialFile& operator=(PartialFile&&) = delete;
  // Leaves the files as they are.
  ~PartialFile();

  const std::string& part_path() const { return part_path_; }
  // The manifest as it was found, or that of a new file.
  const Partial& manifest() const { return manifest_; }
  // The number of bytes that were written, and their CRC-32C.
  int64_t bytes() const { return bytes_; }
  uint32_t crc32c() const { return crc_; }

  // Adds text. After an error only the text before it counts. Errors: those of the system.
  absl::Status Write(std::string_view text);

  // Writes all to disk, and then a manifest that says `progress` and counts the bytes so far. Errors: those of the
  // system; the manifest before then stands.
  absl::Status Checkpoint(const Partial& progress);

  // Gives the file its name and removes the manifest. Errors: those of the system.
  absl::Status Commit();

  // Removes both files.
  void Discard();

 private:
  PartialFile(std::string path, int descriptor);
  absl::Status Resume(const Partial& wanted);
  absl::Status CheckBytes() const;
  absl::Status WriteManifest();
  std::string manifest_path() const { return part_path_ + ".json"; }

  std::string path_;
  std::string part_path_;
  int descriptor_;
  Partial manifest_;
  int64_t bytes_ = 0;
  uint32_t crc_ = 0;
};

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_IO_PARTIAL_FILE_H_
