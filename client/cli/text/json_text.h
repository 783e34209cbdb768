// JSON as the command line writes it: fields under the names of the protos, integers as numbers, enums by name. JSON
// has no number for NaN, which is null, nor for the infinities, which are the texts "Infinity" and "-Infinity".

#ifndef RICOCHET_CLIENT_CLI_TEXT_JSON_TEXT_H_
#define RICOCHET_CLIENT_CLI_TEXT_JSON_TEXT_H_

#include <string>

#include "absl/strings/string_view.h"

namespace google::protobuf {
class Message;
}

namespace ricochet::cli {

// Appends the shortest decimal that reads back as the same double.
void AppendJson(double number, std::string& text);
// Appends a text in quotes.
void AppendJson(absl::string_view words, std::string& text);

// Returns "KEY": and the text in quotes.
std::string JsonMember(absl::string_view key, absl::string_view words);

// Returns the message on one line. Numbers and lists that are not set have their default value, except that an optional
// number, which may be unknown, is null. Messages that are not set are left out.
std::string JsonOf(const google::protobuf::Message& message);

// Returns JsonOf with a line feed.
std::string JsonLineOf(const google::protobuf::Message& message);

// Returns what is set in a message, indented, for people who edit it.
std::string SparseJsonOf(const google::protobuf::Message& message);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_TEXT_JSON_TEXT_H_
