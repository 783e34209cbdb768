// Explains why a JSON text is not a message: where, which field, and what would be right.

#ifndef RICOCHET_CLIENT_CLI_JSON_JSON_ERRORS_H_
#define RICOCHET_CLIENT_CLI_JSON_JSON_ERRORS_H_

#include <string>

namespace google::protobuf {
class Descriptor;
}

namespace ricochet::cli {

// Returns the first error with its line, column and path: "line 2, column 14: pendulum.a: is no field of Pendulum". Returns
// an empty text if none is found, although the parser of the protos may refuse the text for another reason.
std::string ExplainJson(const std::string& text, const google::protobuf::Descriptor& type);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_JSON_JSON_ERRORS_H_
