// JSON as the command line writes it for people who edit it.

#ifndef RICOCHET_CLIENT_CLI_JSON_JSON_TEXT_H_
#define RICOCHET_CLIENT_CLI_JSON_JSON_TEXT_H_

#include <string>

#include "absl/strings/string_view.h"

namespace google::protobuf {
class Message;
}

namespace ricochet::cli {

// Appends a text in quotes.
void AppendJson(absl::string_view words, std::string& text);

// Returns what is set in a message, indented, under the names of its proto.
std::string SparseJsonOf(const google::protobuf::Message& message);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_JSON_JSON_TEXT_H_
