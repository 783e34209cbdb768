// Messages as people write them, in JSON or in the text format of protobuf: one reader for files and bodies, whoever
// takes them.

#ifndef RICOCHET_PROTO_TEXT_MESSAGE_TEXT_H_
#define RICOCHET_PROTO_TEXT_MESSAGE_TEXT_H_

#include <string>
#include <variant>

#include "ricochet/v1/multi_contact.pb.h"
#include "ricochet/v1/scene.pb.h"

namespace ricochet {

// Reads a message of any type from the text of the file `path`, which may have any name or none. A file *.json is JSON;
// *.textproto, *.txtpb and *.pbtxt are in the text format; any other is JSON if it starts with a brace. Returns why the
// text is none, with the line if the parser tells it: "is not a ricochet.v1.Scene in JSON: line 2, column 14: ..."; an
// empty text if it is one.
std::string WhyNoMessage(const std::string& path, const std::string& text, google::protobuf::Message& message);

// The scene of a file, with one contact or several. It is read likewise.
using AnyScene = std::variant<v1::Scene, v1::MultiContactScene>;
std::string WhyNoScene(const std::string& path, const std::string& text, AnyScene& scene);

// Reads a message from JSON, likewise.
std::string WhyNoJson(const std::string& text, google::protobuf::Message& message);

}  // namespace ricochet

#endif  // RICOCHET_PROTO_TEXT_MESSAGE_TEXT_H_
