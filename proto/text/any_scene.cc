#include "proto/text/any_scene.h"

#include "absl/strings/match.h"
#include "proto/text/message_text.h"

namespace ricochet {

std::string WhyNoScene(const std::string& path, const std::string& text, AnyScene& scene) {
  const std::string wrong = WhyNoMessage(path, text, scene.emplace<v1::Scene>());
  if (wrong.empty()) return "";
  const std::string wrong_as_several = WhyNoMessage(path, text, scene.emplace<v1::MultiContactScene>());
  // A text that is neither is explained as what it is most likely meant to be: only several contacts have this field.
  const bool means_several = absl::StrContains(text, "contacts");
  return wrong_as_several.empty() || means_several ? wrong_as_several : wrong;
}

}  // namespace ricochet
