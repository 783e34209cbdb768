// The files that this run reads and writes: none is written that is also an input or another output.

#ifndef RICOCHET_CLIENT_CLI_IO_USED_FILES_H_
#define RICOCHET_CLIENT_CLI_IO_USED_FILES_H_

#include <string>

#include "absl/status/status.h"

namespace ricochet::cli {

enum class FileUse { kRead, kWritten };

// Notes that this run uses `path`; "-" is standard input or output. `flag` names it in errors, and may be empty. Two
// paths are one file if links lead them to the same inode or, where there is no file yet, to the same place. A pipe or
// a device may be used more than once; neither standard input nor standard output may. Errors: INVALID_ARGUMENT if one
// file is written and has another use; those of FileToWrite; those of the system if nothing can be written there.
absl::Status UseFile(FileUse use, const std::string& flag, const std::string& path);

// Begins another run, for a program that has several.
void ForgetUsedFiles();

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_IO_USED_FILES_H_
