#include "proto/text/message_text.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/text_format.h>
#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "proto/text/json_errors.h"
#include "proto/text/json_matrices.h"
#include "proto/wire/message_content.h"

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

// The parser says: Message type "ricochet.v1.Pendulum" has no field named "am".
std::string WithNearestField(const std::vector<std::string>& quoted) {
  const auto* const type = google::protobuf::DescriptorPool::generated_pool()->FindMessageTypeByName(quoted[1]);
  return absl::StrCat(quoted[1], " has no field \"", quoted[3], "\"",
                      type == nullptr ? "" : FieldHint(*type, quoted[3]));
}

// The parser says: Field "b" is specified along with field "a", another member of oneof "system".
std::string InWords(const std::string& message) {
  const std::vector<std::string> quoted = absl::StrSplit(message, '"');
  if (quoted.size() == 5 && absl::StrContains(message, "has no field named")) return WithNearestField(quoted);
  if (quoted.size() != 7 || !absl::StrContains(message, "another member of oneof")) return message;
  return absl::StrCat("\"", quoted[1], "\" cannot be given beside \"", quoted[3], "\": there is one ",
                      absl::StrReplaceAll(quoted[5], {{"_", " "}}), " only");
}

// Keeps the first error of the textproto parser.
class FirstError final : public google::protobuf::io::ErrorCollector {
 public:
  void AddError(int line, google::protobuf::io::ColumnNumber column, const std::string& message) override {
    if (text.empty()) text = absl::StrCat("line ", line + 1, ", column ", column + 1, ": ", InWords(message));
  }
  std::string text;
};

// Says which enum has a value that it does not know, as both parsers take any number for one.
std::string UnknownIn(const google::protobuf::Message& message) {
  constexpr int64_t kAnyNumber = std::numeric_limits<int64_t>::max();
  return std::string(
      CheckContent(message.SerializeAsString(), *message.GetDescriptor(), kAnyNumber).status().message());
}

// Names a number that the parser of textproto has taken for 0. It takes one that is too large for infinity, which the
// rules of a scene refuse.
std::string TooSmallIn(const std::string& text) {
  namespace io = google::protobuf::io;
  FirstError errors;
  io::ArrayInputStream stream(text.data(), static_cast<int>(text.size()));
  io::Tokenizer tokens(&stream, &errors);
  tokens.set_allow_f_after_float(true);
  tokens.set_comment_style(io::Tokenizer::SH_COMMENT_STYLE);
  while (tokens.Next()) {
    const io::Tokenizer::Token& token = tokens.current();
    const bool is_zero = token.type == io::Tokenizer::TYPE_FLOAT && io::Tokenizer::ParseFloat(token.text) == 0.0;
    const std::string rule = is_zero ? WhyNoDouble(token.text) : "";
    if (rule.empty()) continue;
    return absl::StrCat("line ", token.line + 1, ", column ", token.column + 1, ": ", token.text, " must ", rule);
  }
  return "";
}

bool IsJson(const std::string& path, const std::string& text) {
  if (absl::EndsWithIgnoreCase(path, ".json")) return true;
  for (const char* ending : {".textproto", ".txtpb", ".pbtxt"}) {
    if (absl::EndsWithIgnoreCase(path, ending)) return false;
  }
  const size_t start = text.find_first_not_of(" \t\r\n");
  return start != std::string::npos && text[start] == '{';
}

std::string WhyNoText(const std::string& text, google::protobuf::Message& message) {
  FirstError error;
  google::protobuf::TextFormat::Parser parser;
  parser.RecordErrorsTo(&error);
  if (parser.ParseFromString(text, &message)) {
    error.text = TooSmallIn(text);
    if (error.text.empty()) error.text = UnknownIn(message);
  }
  if (error.text.empty()) return "";
  return absl::StrCat("is not a ", message.GetTypeName(), " in textproto: ", error.text);
}

std::string WhyNotAs(const std::string& path, const std::string& text, google::protobuf::Message& message) {
  return IsJson(path, text) ? WhyNoJson(text, message) : WhyNoText(text, message);
}

// Says that the text is in the other of the two forms than the name of its file tells; empty if it is not.
std::string OtherForm(const std::string& path, const std::string& text, const google::protobuf::Message& message) {
  const bool named_json = IsJson(path, text);
  const std::unique_ptr<google::protobuf::Message> other(message.New());
  const std::string wrong = named_json ? WhyNoText(text, *other) : WhyNoJson(text, *other);
  if (!wrong.empty() || other->ByteSizeLong() == 0) return "";
  return named_json ? "is in textproto, whose files are named .txtpb" : "is in JSON, whose files are named .json";
}

}  // namespace

std::string WhyNoMessage(const std::string& path, const std::string& text, google::protobuf::Message& message) {
  std::string wrong = WhyNotAs(path, text, message);
  if (wrong.empty()) return "";
  if (std::string form = OtherForm(path, text, message); !form.empty()) return form;
  v1::Scene one;
  if (message.GetDescriptor() == v1::MultiContactScene::descriptor() && WhyNotAs(path, text, one).empty()) {
    return "has one contact: `ricochet solve --scene` takes it";
  }
  v1::MultiContactScene several;
  if (message.GetDescriptor() == v1::Scene::descriptor() && WhyNotAs(path, text, several).empty()) {
    return "has several contacts: `ricochet multicontact --scene` takes it";
  }
  return wrong;
}

std::string WhyNoJson(const std::string& text, google::protobuf::Message& message) {
  const absl::StatusOr<std::string> flat = WithFlatMatrices(text);
  std::string wrong(flat.ok() ? ExplainJson(*flat, *message.GetDescriptor()) : flat.status().message());
  if (wrong.empty()) {
    const auto status = google::protobuf::util::JsonStringToMessage(*flat, &message);
    wrong = status.ok() ? UnknownIn(message) : status.message().ToString();
    if (wrong.empty()) return "";
  }
  return absl::StrCat("is not a ", message.GetTypeName(), " in JSON: ", wrong);
}

std::string WhyNoScene(const std::string& path, const std::string& text, AnyScene& scene) {
  if (NamesContacts(text)) return WhyNoMessage(path, text, scene.emplace<v1::MultiContactScene>());
  return WhyNoMessage(path, text, scene.emplace<v1::Scene>());
}

}  // namespace ricochet
