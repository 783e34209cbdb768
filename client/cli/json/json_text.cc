#include "client/cli/json/json_text.h"

#include <google/protobuf/message.h>
#include <google/protobuf/util/json_util.h>

#include <nlohmann/json.hpp>

namespace ricochet::cli {

void AppendJson(absl::string_view words, std::string& text) {
  text += nlohmann::json(std::string(words)).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string SparseJsonOf(const google::protobuf::Message& message) {
  google::protobuf::util::JsonPrintOptions options;
  options.preserve_proto_field_names = true;
  std::string text;
  // A message that was parsed has only fields that JSON can tell.
  static_cast<void>(google::protobuf::util::MessageToJsonString(message, &text, options));
  return nlohmann::ordered_json::parse(text).dump(2) + "\n";
}

}  // namespace ricochet::cli
