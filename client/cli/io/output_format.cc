#include "client/cli/io/output_format.h"

#include <algorithm>
#include <filesystem>

#include "absl/algorithm/container.h"
#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/cli/io/output.h"

namespace ricochet::cli {
namespace {

struct Known {
  Format format;
  const char* name;
  const char* meaning;
  std::vector<std::string> endings;
};

// No command has both text and textproto, so that .txt means one of them.
const std::vector<Known>& AllKnown() {
  static const auto* const known = new std::vector<Known>{
      {Format::kText, "text", "tables", {"txt"}},
      {Format::kTextproto, "textproto", "the text of protobuf", {"textproto", "txtpb", "pbtxt", "txt"}},
      {Format::kJson, "json", "one document", {"json"}},
      {Format::kJsonLines, "jsonl", "an object on each line", {"jsonl"}},
      {Format::kCsv, "csv", "rows at full precision", {"csv"}},
      {Format::kNpy, "npy", "records for NumPy", {"npy"}},
      {Format::kNetcdf, "netcdf", "a NetCDF-4 file", {"nc"}}};
  return *known;
}

const Known& KnownAs(Format format) { return AllKnown()[static_cast<size_t>(format)]; }

// Returns the flag that writes files of this ending, or null.
const char* FlagForEnding(const std::string& ending) {
  constexpr const char* kPictures[] = {"svg", "png", "pdf",  "jpg", "jpeg", "gif",
                                       "eps", "ps",  "webp", "bmp", "tif",  "tiff"};
  if (absl::c_linear_search(kPictures, ending)) return "--plot";
  return ending == "html" || ending == "htm" ? "--html" : nullptr;
}

// True if the ending is that of a known kind of file.
bool SaysAKind(const std::string& ending) {
  return FlagForEnding(ending) != nullptr ||
         std::any_of(AllKnown().begin(), AllKnown().end(),
                     [&ending](const Known& one) { return absl::c_linear_search(one.endings, ending); });
}

std::string EndingsOf(absl::Span<const Format> formats) {
  std::vector<std::string> endings;
  for (const Format format : formats) {
    const std::vector<std::string>& more = KnownAs(format).endings;
    endings.insert(endings.end(), more.begin(), more.end());
  }
  return JoinedEndings(endings);
}

}  // namespace

std::string FormatName(Format format) { return KnownAs(format).name; }

std::string FormatMeaning(Format format) { return KnownAs(format).meaning; }

std::string EndingOf(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  return ending.empty() ? "" : absl::AsciiStrToLower(ending.substr(1));
}

std::string FlagForFile(const std::string& path) {
  const char* const flag = FlagForEnding(EndingOf(path));
  return flag == nullptr ? "" : flag;
}

std::string JoinedEndings(const std::vector<std::string>& endings) {
  std::string joined;
  for (size_t i = 0; i < endings.size(); ++i) {
    absl::StrAppend(&joined, i == 0 ? "." : i + 1 < endings.size() ? ", ." : " or .", endings[i]);
  }
  return joined;
}

absl::StatusOr<Format> ChooseFormat(absl::Span<const Format> formats, const std::string& named,
                                    const std::string& path) {
  const std::string ending = EndingOf(path);
  const auto said = std::find_if(formats.begin(), formats.end(),
                                 [&](Format format) { return absl::c_linear_search(KnownAs(format).endings, ending); });
  if (!named.empty()) {
    const Format format =
        *std::find_if(formats.begin(), formats.end(), [&](Format one) { return FormatName(one) == named; });
    if (!SaysAKind(ending) || absl::c_linear_search(KnownAs(format).endings, ending)) return format;
    return absl::InvalidArgumentError(absl::StrCat("-o ", path, ": must not end in .", ending, " beside --format ",
                                                   named, ", whose files end in ", EndingsOf({&format, 1})));
  }
  if (said != formats.end()) return *said;
  if (path.empty() || (!SaysAKind(ending) && IsDevice(path))) return formats.front();
  return absl::InvalidArgumentError(absl::StrCat("-o ", path, ": must end in ", EndingsOf(formats),
                                                 SaysAKind(ending) ? "" : ", or --format must say what it is"));
}

absl::Status CheckOneTable(Format format, std::initializer_list<TableOption> options) {
  std::vector<std::string> given;
  for (const TableOption& option : options) {
    if (option.is_given) given.emplace_back(option.name);
  }
  if (format != Format::kCsv || given.size() < 2) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat(absl::StrJoin(given, ", "),
                                                 " cannot be combined as csv, which is one table: give one of them, or "
                                                 "--format json, which has all"));
}

}  // namespace ricochet::cli
