#include "client/cli/text/json_text.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>
#include <google/protobuf/util/json_util.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "core/base/decimal.h"
#include "core/base/invariant.h"

namespace ricochet::cli {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;

void AppendMessage(const Message& message, std::string& text);

// Appends entry `index` of a list, or with index -1 the value of a field that is no list.
void AppendValue(const Message& message, const FieldDescriptor& field, int index, std::string& text) {
  const Reflection& in = *message.GetReflection();
  const auto get = [&](auto of_field, auto of_entry) {
    return index >= 0 ? (in.*of_entry)(message, &field, index) : (in.*of_field)(message, &field);
  };
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return AppendJson(get(&Reflection::GetDouble, &Reflection::GetRepeatedDouble), text);
    case FieldDescriptor::CPPTYPE_INT64:
      return AppendDecimal(get(&Reflection::GetInt64, &Reflection::GetRepeatedInt64), text);
    case FieldDescriptor::CPPTYPE_INT32:
      return AppendDecimal(get(&Reflection::GetInt32, &Reflection::GetRepeatedInt32), text);
    case FieldDescriptor::CPPTYPE_BOOL:
      text += get(&Reflection::GetBool, &Reflection::GetRepeatedBool) ? "true" : "false";
      return;
    case FieldDescriptor::CPPTYPE_ENUM:
      return AppendJson(get(&Reflection::GetEnum, &Reflection::GetRepeatedEnum)->name(), text);
    case FieldDescriptor::CPPTYPE_STRING: {
      const std::string value = get(&Reflection::GetString, &Reflection::GetRepeatedString);
      return AppendJson(field.type() == FieldDescriptor::TYPE_BYTES ? absl::Base64Escape(value) : value, text);
    }
    case FieldDescriptor::CPPTYPE_MESSAGE:
      return AppendMessage(index >= 0 ? in.GetRepeatedMessage(message, &field, index) : in.GetMessage(message, &field),
                           text);
    case FieldDescriptor::CPPTYPE_FLOAT:
    case FieldDescriptor::CPPTYPE_UINT32:
    case FieldDescriptor::CPPTYPE_UINT64:
      break;
  }
  CheckInvariant(false, "the service's messages have fields of these kinds only");
}

void AppendList(const Message& message, const FieldDescriptor& field, std::string& text) {
  text.push_back('[');
  for (int i = 0; i < message.GetReflection()->FieldSize(message, &field); ++i) {
    if (i > 0) text.push_back(',');
    AppendValue(message, field, i, text);
  }
  text.push_back(']');
}

void AppendMessage(const Message& message, std::string& text) {
  text.push_back('{');
  for (int i = 0; i < message.GetDescriptor()->field_count(); ++i) {
    const FieldDescriptor& field = *message.GetDescriptor()->field(i);
    const bool is_unset = field.has_presence() && !message.GetReflection()->HasField(message, &field);
    const bool is_unknown = is_unset && field.has_optional_keyword();
    if (is_unset && !is_unknown) continue;
    if (text.back() != '{') text.push_back(',');
    AppendJson(field.name(), text);
    text.push_back(':');
    if (is_unknown) {
      text += "null";
    } else if (field.is_repeated()) {
      AppendList(message, field, text);
    } else {
      AppendValue(message, field, -1, text);
    }
  }
  text.push_back('}');
}

}  // namespace

void AppendJson(double number, std::string& text) {
  if (std::isnan(number)) {
    text += "null";
  } else if (std::isinf(number)) {
    text += number > 0.0 ? "\"Infinity\"" : "\"-Infinity\"";
  } else {
    AppendDecimal(number, text);
  }
}

void AppendJson(absl::string_view words, std::string& text) {
  text += nlohmann::json(std::string(words)).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string JsonMember(absl::string_view key, absl::string_view words) {
  std::string member = absl::StrCat("\"", key, "\":");
  AppendJson(words, member);
  return member;
}

std::string JsonOf(const Message& message) {
  std::string text;
  AppendMessage(message, text);
  return text;
}

std::string JsonLineOf(const google::protobuf::Message& message) { return JsonOf(message) + "\n"; }

std::string SparseJsonOf(const Message& message) {
  google::protobuf::util::JsonPrintOptions options;
  options.preserve_proto_field_names = true;
  std::string text;
  // A message that was parsed has only fields that JSON can tell.
  static_cast<void>(google::protobuf::util::MessageToJsonString(message, &text, options));
  return nlohmann::ordered_json::parse(text).dump(2) + "\n";
}

}  // namespace ricochet::cli
