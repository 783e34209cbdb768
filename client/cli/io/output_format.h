// The format of an output: that of --format, else the one that the ending of the file's name says.

#ifndef RICOCHET_CLIENT_CLI_IO_OUTPUT_FORMAT_H_
#define RICOCHET_CLIENT_CLI_IO_OUTPUT_FORMAT_H_

#include <initializer_list>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/types/span.h"

namespace ricochet::cli {

// Text is tables for people, or all that a command has to say in words. npy and netcdf are for programs that take
// arrays.
enum class Format { kText, kTextproto, kJson, kJsonLines, kCsv, kNpy, kNetcdf };

// Returns the name of a format as a user types it: "csv".
std::string FormatName(Format format);
// Returns what a format is in a few words: "rows at full precision".
std::string FormatMeaning(Format format);

// Returns what follows the last dot of a file's name, in lower case, or nothing if there is no dot.
std::string EndingOf(const std::string& path);

// Returns the flag that writes files like `path`: --plot for pictures, --html for pages, nothing for others.
std::string FlagForFile(const std::string& path);

// Returns ".svg, .png or .pdf".
std::string JoinedEndings(const std::vector<std::string>& endings);

// Returns the format in which a command that has `formats` writes to `path`, which is empty for standard output.
// `named` is the value of --format, empty if it was not given; standard output and devices then have the first of
// `formats`. Errors: INVALID_ARGUMENT for an ending of another format than `named`, for one that none of `formats` has,
// such as that of a picture or a page, and for one that says nothing if `named` does not either.
absl::StatusOr<Format> ChooseFormat(absl::Span<const Format> formats, const std::string& named,
                                    const std::string& path);

// CSV is one table, so that options which each ask for a table of their own exclude each other.

// An option that changes which table an answer has, and whether it was given.
struct TableOption {
  const char* name;
  bool is_given;
};

// Errors: INVALID_ARGUMENT that names the options, if the format is CSV and several are given.
absl::Status CheckOneTable(Format format, std::initializer_list<TableOption> options);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_IO_OUTPUT_FORMAT_H_
