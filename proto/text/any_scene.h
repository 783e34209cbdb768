// AnyScene: what the file of a scene holds, one contact or several.

#ifndef RICOCHET_PROTO_TEXT_ANY_SCENE_H_
#define RICOCHET_PROTO_TEXT_ANY_SCENE_H_

#include <string>
#include <variant>

#include "ricochet/v1/multi_contact.pb.h"
#include "ricochet/v1/scene.pb.h"

namespace ricochet {

using AnyScene = std::variant<v1::Scene, v1::MultiContactScene>;

// Reads a scene from the text of the file `path`. Returns why the text is none, as WhyNoMessage does
// (proto/text/message_text.h); an empty text if it is one.
std::string WhyNoScene(const std::string& path, const std::string& text, AnyScene& scene);

}  // namespace ricochet

#endif  // RICOCHET_PROTO_TEXT_ANY_SCENE_H_
