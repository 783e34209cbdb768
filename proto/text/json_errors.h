// Explains why a JSON text is not a message: where, which field, and what would be right.

#ifndef RICOCHET_PROTO_TEXT_JSON_ERRORS_H_
#define RICOCHET_PROTO_TEXT_JSON_ERRORS_H_

#include <string>

#include "absl/strings/string_view.h"

namespace google::protobuf {
class Descriptor;
}

namespace ricochet {

// Returns the first error with its line, column and path: "line 2, column 14: pendulum.a: is no field of Pendulum". A
// field that is given twice is an error, although the parser of the protos would silently take the second. Returns an
// empty text if there is none; the parser of the protos may still refuse the text for another reason. `type` is a
// message of ricochet.v1, none of which holds a map or a type of protobuf itself (tests/proto/style_test.cc).
std::string ExplainJson(const std::string& text, const google::protobuf::Descriptor& type);

// Returns "" or, if no double holds the decimal because it exceeds the largest or would become 0, what it must be.
std::string WhyNoDouble(absl::string_view decimal);

// Returns what is said after the name of a field that the type lacks: the nearest that it has, "; did you mean a_m?",
// or all.
std::string FieldHint(const google::protobuf::Descriptor& type, const std::string& name);

}  // namespace ricochet

#endif  // RICOCHET_PROTO_TEXT_JSON_ERRORS_H_
