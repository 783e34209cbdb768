#include "proto/text/any_scene.h"

#include <algorithm>
#include <vector>

#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "proto/text/message_text.h"

namespace ricochet {
namespace {

// True if the text has the field `contacts`, which only scenes with several contacts have, outside comments.
bool NamesContacts(const std::string& text) {
  for (const absl::string_view line : absl::StrSplit(text, '\n')) {
    const absl::string_view code = line.substr(0, line.find('#'));
    const std::vector<absl::string_view> words = absl::StrSplit(code, absl::ByAnyChar(" \t\r{}[]<>:,;\"'"));
    if (std::find(words.begin(), words.end(), "contacts") != words.end()) return true;
  }
  return false;
}

}  // namespace

std::string WhyNoScene(const std::string& path, const std::string& text, AnyScene& scene) {
  if (NamesContacts(text)) return WhyNoMessage(path, text, scene.emplace<v1::MultiContactScene>());
  return WhyNoMessage(path, text, scene.emplace<v1::Scene>());
}

}  // namespace ricochet
