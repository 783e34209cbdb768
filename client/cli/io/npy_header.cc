#include "client/cli/io/npy_header.h"

#include <array>

#include "absl/strings/numbers.h"
#include "absl/strings/str_split.h"

namespace ricochet::cli {
namespace {

// A header of more bytes would name thousands of columns.
constexpr uint32_t kMostHeader = 1 << 20;

}  // namespace

absl::StatusOr<std::string> ReadNpyHeader(std::istream& stream) {
  std::array<char, 8> magic;
  stream.read(magic.data(), magic.size());
  // The length of the header has two bytes in version 1 of the format, else four.
  uint32_t length = 0;
  if (stream) stream.read(reinterpret_cast<char*>(&length), magic[6] == 1 ? 2 : 4);
  if (!stream || length > kMostHeader) return absl::InvalidArgumentError("ends in its header");
  std::string text(length, '\0');
  if (!stream.read(text.data(), length)) return absl::InvalidArgumentError("ends in its header");
  return text;
}

std::optional<std::vector<int64_t>> ShapeIn(absl::string_view header) {
  if (!SkipPast("'shape': (", header)) return std::nullopt;
  std::vector<int64_t> shape;
  for (const absl::string_view part : absl::StrSplit(TakeUntil(')', header), ',', absl::SkipWhitespace())) {
    int64_t length = 0;
    if (!absl::SimpleAtoi(part, &length) || length < 0) return std::nullopt;
    shape.push_back(length);
  }
  return shape;
}

bool SkipPast(absl::string_view mark, absl::string_view& text) {
  const size_t place = text.find(mark);
  if (place == absl::string_view::npos) return false;
  text.remove_prefix(place + mark.size());
  return true;
}

absl::string_view TakeUntil(char end, absl::string_view& text) {
  const absl::string_view part = text.substr(0, text.find(end));
  text.remove_prefix(part.size());
  return part;
}

}  // namespace ricochet::cli
